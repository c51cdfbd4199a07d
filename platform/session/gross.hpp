// Which poses are gross: so far off that a robot must not be moved by them.
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
  double tip_sigma_m = 0;    // stated: root of the tip covariance's trace; 0: none is stated
  bool misassigned = false;  // a marker was given a blob that is not its own
};

// The rotation is off by more than 15 deg; or the tip by more than 20 mm and by more than three
// stated sigmas; or by more than 5 mm under a wrong marker assignment.
[[nodiscard]] inline bool is_gross(const TrackingError& error) {
  if (error.angle_rad > k_gross_angle_rad) return true;
  if (error.misassigned && error.tip_m > k_gross_misassigned_m) return true;
  return error.tip_m > k_gross_tip_m && error.tip_m > k_gross_sigmas * error.tip_sigma_m;
}

}  // namespace glint
