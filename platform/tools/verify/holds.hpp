// Detection of static intervals of a tool: touches of a point, and a rest.
#pragma once

#include <span>
#include <vector>

#include "platform/tools/verify/tip_sightings.hpp"

namespace glint {

inline constexpr double k_static_min_s = 0.75;
inline constexpr double k_rest_min_s = 18;  // 20 s minus the margins of the detection

// Observations first to first + count - 1 of a series.
struct StaticInterval {
  std::size_t first = 0, count = 0;
  double seconds = 0;
};

// A static interval is a run of blocks of 0.25 s whose mean tip and marker centroid move by less
// than 10 mm between blocks. Its first and last block are excluded: they overlap the motion around
// it.
[[nodiscard]] std::vector<StaticInterval> find_static_intervals(const TipSeries& series);

// Weighted mean of successive observations. The weight is the inverse variance of each observation
// from noise and headset.
struct Touch {
  TipObservation mean;  // random_m2 is of the mean; motion_covariance_m2 of one observation
  double seconds = 0;   // effective duration under the weights
};
[[nodiscard]] Touch mean_of(const TipSeries& series, const StaticInterval& interval);

// Splits the interval into means over about `seconds` each.
[[nodiscard]] std::vector<Touch> pieces_of(const TipSeries& series, const StaticInterval& interval,
                                           double seconds);

}  // namespace glint
