// Spans in which a tool stands still: touches of a point, and a rest.
#pragma once

#include <span>
#include <vector>

#include "platform/verify/tip_sightings.hpp"

namespace glint {

inline constexpr double k_hold_min_s = 0.75;
inline constexpr double k_rest_min_s = 18;  // "20 s", less what the detection leaves out

// Sightings first .. first + count of a series.
struct Hold {
  std::size_t first = 0, count = 0;
  double seconds = 0;
};

// Blocks of a quarter of a second that lie within a few millimetres of the block before, tip and
// markers alike, make a hold; its first and last block belong to the motion around it.
[[nodiscard]] std::vector<Hold> find_holds(const TipSeries& series);

// The mean of sightings that follow each other, weighed by the inverse of what noise and headset
// leave open in each.
struct Touch {
  TipSighting mean;    // its random_m2 is that of the mean; moving_m2 that of one sighting
  double seconds = 0;  // of equal weights
};
[[nodiscard]] Touch mean_of(const TipSeries& series, const Hold& hold);

// The hold in pieces of about `seconds`.
[[nodiscard]] std::vector<Touch> pieces_of(const TipSeries& series, const Hold& hold,
                                           double seconds);

}  // namespace glint
