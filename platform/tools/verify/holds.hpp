// Detection of static intervals of a tool: touches of a point, and a rest.
#pragma once

#include <span>
#include <vector>

#include "platform/tools/verify/tip_sightings.hpp"

namespace glint {

inline constexpr double k_hold_min_s = 0.75;
inline constexpr double k_rest_min_s = 18;  // 20 s minus the margins of the detection

// Sightings first to first + count - 1 of a series.
struct Hold {
  std::size_t first = 0, count = 0;
  double seconds = 0;
};

// A hold is a run of blocks of 0.25 s whose mean tip and marker centroid move by less than 10 mm
// between blocks. Its first and last block are excluded: they overlap the motion around it.
[[nodiscard]] std::vector<Hold> find_holds(const TipSeries& series);

// Weighted mean of successive sightings. The weight is the inverse variance of each sighting from
// noise and headset.
struct Touch {
  TipSighting mean;    // random_m2 is of the mean; moving_m2 of one sighting
  double seconds = 0;  // effective duration under the weights
};
[[nodiscard]] Touch mean_of(const TipSeries& series, const Hold& hold);

// Splits the hold into means over about `seconds` each.
[[nodiscard]] std::vector<Touch> pieces_of(const TipSeries& series, const Hold& hold,
                                           double seconds);

}  // namespace glint
