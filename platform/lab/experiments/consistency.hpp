// Consistency of errors with their stated covariance: normalised squared errors against chi-square
// limits.
//
// Source: Bar-Shalom, Li and Kirubarajan 2001, section 5.4.2 (normalised estimation error squared).
#pragma once

#include <cmath>

#include "kernels/motion/cholesky.hpp"
#include "kernels/motion/motion_filter.hpp"

namespace glint {

// Chi-square quantiles with 6 degrees of freedom.
inline constexpr double k_inside_95 = 12.592, k_inside_999 = 22.458;

struct Consistency {
  double sum = 0;
  int n = 0, inside = 0;

  void add(const UncertainPose& estimate, const Pose& truth) {
    const Cholesky<6> factor(estimate.covariance);
    const double squared =
        factor.positive ? factor.squared_length(pose_difference(truth, estimate.pose)) : HUGE_VAL;
    sum += squared;
    ++n;
    if (squared <= k_inside_95) ++inside;
  }
  void add(const Consistency& other) {
    sum += other.sum;
    n += other.n;
    inside += other.inside;
  }
  [[nodiscard]] double nees_per_axis() const { return sum / (6.0 * n); }
  [[nodiscard]] double inside_95_percent() const { return 100.0 * inside / n; }
};

}  // namespace glint
