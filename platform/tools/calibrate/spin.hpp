// Spin calibration: the tool's rotation axis, from poses while it spins in place or along that
// axis.
//
// Initial guess: the tool direction that the rotations move least. Refinement: Ceres on
// R axis_tool - axis_tracker (kernels/calibrate/axis_residual.hpp) with a Cauchy loss; then
// outliers are removed and the fit is repeated without loss.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "kernels/motion/interpolate.hpp"
#include "platform/tools/calibrate/rotation_spread.hpp"

namespace glint {

struct SpinSettings {
  double stop_sigma_rad = 0;       // stop when the axis's sigma is below; 0: use every pose
  double rotation_min_rad = 0.35;  // rms about the axis: rotation by 70 degrees to and fro
  double wobble_max_rad = 0.10;    // rms of the axis; above it the rotation had no single axis
  Vector3 axis_side_m = Vector3::UnitZ();  // the axis points to this side of the tool
};

inline constexpr int k_spin_poses_min = 12;

struct SpinResult {
  Vector3 axis = Vector3::UnitZ();          // unit, tool frame
  Vector3 axis_tracker = Vector3::UnitZ();  // unit, tracker frame
  Vector3 foot_m = Vector3::Zero();  // the axis's point nearest to the tool's origin, tool frame
  Matrix3 axis_covariance_rad2 = Matrix3::Zero();
  double axis_sigma_rad = 0;  // of the less certain direction across the axis
  double rms_rad = 0;         // wobble of the axis over the kept poses
  double foot_rms_m = 0;      // rms distance of the foot from the axis's line
  double variance_inflation = 1;
  RotationSpread spread;
  std::vector<double> wobble_rad;  // of each pose used
  std::vector<bool> kept;
  int poses_used = 0;
  int outliers = 0;
  bool sigma_reached = true;
};

// Throws InputError, naming `what` (a file), for too few poses, too little rotation or no one
// axis.
[[nodiscard]] SpinResult calibrate_spin(std::span<const TimedPose> poses,
                                        const SpinSettings& settings, const std::string& what);

}  // namespace glint
