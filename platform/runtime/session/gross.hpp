// Criterion of a gross pose error: too large an error for moving a robot.
#pragma once

#include "kernels/angles.hpp"

namespace glint {

inline constexpr double k_gross_tip_m = 0.020;
inline constexpr double k_gross_sigmas = 3;
inline constexpr double k_gross_angle_rad = 15 * k_radians_per_degree;
inline constexpr double k_gross_misassigned_m = 0.005;

struct TrackingError {
  double tip_m = 0;
  double angle_rad = 0;
  double tip_sigma_m = 0;    // stated: root of the tip covariance's trace; 0: not stated
  bool misassigned = false;  // a marker was assigned another reflector's blob
};

// Returns whether the rotation error is above 15 deg, or the tip error above 20 mm and above three
// stated standard deviations, or the tip error above 5 mm with a wrong marker assignment.
[[nodiscard]] inline bool is_gross(const TrackingError& error) {
  if (error.angle_rad > k_gross_angle_rad) return true;
  if (error.misassigned && error.tip_m > k_gross_misassigned_m) return true;
  return error.tip_m > k_gross_tip_m && error.tip_m > k_gross_sigmas * error.tip_sigma_m;
}

}  // namespace glint
