// Spin calibration: about which axis of the tool it was turned, from poses while it spins in place
// or along that axis.
//
// Start: the direction that the rotations move least. Then Ceres on R axis_tool - axis_tracker
// (kernels/calibrate/axis_residual.hpp) with a Cauchy loss, outliers removed, without loss again.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "kernels/motion/interpolate.hpp"
#include "platform/calibrate/rotation_spread.hpp"

namespace glint {

struct SpinSettings {
  double stop_sigma_rad = 0;     // stop as soon as the axis's sigma is below; 0: use every pose
  double turn_min_rad = 0.35;    // rms about the axis: a turn of 70 degrees to and fro
  double wobble_max_rad = 0.10;  // rms of the axis: more, and there was no one axis
  Vector3 towards_m = Vector3::UnitZ();  // the axis points to this side of the tool
};

inline constexpr int k_spin_poses_min = 12;

struct SpinResult {
  Vector3 axis = Vector3::UnitZ();          // unit, tool frame
  Vector3 axis_tracker = Vector3::UnitZ();  // where it pointed
  Vector3 foot_m = Vector3::Zero();         // the axis's point nearest to the tool's origin
  Matrix3 axis_covariance_rad2 = Matrix3::Zero();
  double axis_sigma_rad = 0;  // of the worse of both directions across
  double rms_rad = 0;         // of the axis's wobble over the poses kept
  double foot_rms_m = 0;      // how far off the axis's line passes
  double correlated = 1;
  RotationSpread spread;
  std::vector<double> wobble_rad;  // of each pose used
  std::vector<bool> kept;
  int poses_used = 0;
  int outliers = 0;
  bool sigma_reached = true;
};

// Throws InputError, naming `what` (a file), for too few poses, too little turn or no one axis.
[[nodiscard]] SpinResult calibrate_spin(std::span<const StampedPose> poses,
                                        const SpinSettings& settings, const std::string& what);

}  // namespace glint
