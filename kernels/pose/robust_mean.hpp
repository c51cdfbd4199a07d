// Robust mean of ranges near their median (MAD gate): mixed pixels at a marker's rim are metres
// away.
//
// What:     the mean of all values within 3 sigma of the median, sigma from the median absolute
//           deviation.
// Cost:     that of sort_pairs.hpp, and two passes of two values at a time.
// Worst:    data independent for a given count.
// Accuracy: sigma / sqrt(n) for n values with normal noise; up to half of them may be outliers of
//           any size.
// Source:   Huber, "Robust Statistics" (1981), section 5.1: 1.4826 times the deviation is a sigma.
#pragma once

#include <array>

#include "kernels/nonblocking.hpp"
#include "kernels/two_doubles.hpp"

namespace glint {

inline constexpr int k_range_values_max = 64;
using RangeValues = std::array<double, k_range_values_max>;

struct RobustMean {
  double mean = 0;
  double median = 0;
  double gate = 0;  // maximum distance of an inlier from the median: three sigma
  int near = 0;     // number of inliers
};

// Sums, two at a time, the values whose tested quantity is within the gate around the median.
struct NearSum {
  TwoDoubles sum{};
  TwoMasks minus_count{};  // a set lane is -1

  void add(const RobustMean& found, const TwoDoubles& tested, const TwoDoubles& value) {
    const TwoDoubles beyond = tested - broadcast_two(found.median);
    const TwoMasks near =
        (beyond <= broadcast_two(found.gate)) & (-beyond <= broadcast_two(found.gate));
    sum += keep_lanes(near, value);
    minus_count += near;
  }
  void add(const NearSum& other) {
    sum += other.sum;
    minus_count += other.minus_count;
  }
  [[nodiscard]] int count() const { return static_cast<int>(-(minus_count[0] + minus_count[1])); }
  [[nodiscard]] double mean_or(double otherwise) const {
    return count() > 0 ? (sum[0] + sum[1]) / count() : otherwise;
  }
};

// Uses the first `count` values, 1..k_range_values_max. The gate is at least gate_min.
[[nodiscard]] RobustMean robust_mean(const RangeValues& values, int count,
                                     double gate_min) noexcept GLINT_NONBLOCKING;

}  // namespace glint
