// Pivot calibration: where a tool's tip is, from poses while it stands in a dent and the tool
// turns.
//
// Start: the linear least squares of R_i tip + t_i = post, reweighted (Huber 1964) so that a few
// wild poses do not carry it away. Its residuals along and across the lever tell the noise of
// position and rotation apart. Then Ceres, with every frame's true rotation as an unknown
// (kernels/calibrate/pivot_residual.hpp), a Cauchy loss, outliers removed, and again without loss.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "kernels/motion/interpolate.hpp"
#include "platform/calibrate/rotation_spread.hpp"

namespace glint {

struct PivotSettings {
  // A point of the tool whose measured position errs independently of the measured rotation: the
  // middle of its markers. Unknown: the origin.
  Vector3 centre_m = Vector3::Zero();
  double scale_sigma = 0;        // of all positions, a ratio: moves the tip along its arm
  double stop_sigma_m = 0;       // stop as soon as the tip's sigma is below; 0: use every pose
  double spread_min_rad = 0.05;  // moved less than this, a direction's part of the tip is a guess
  double inlier_chi_square = 16.3;  // of 3 components: one good pose in 1000 is left out
  double rms_max_m = 0.02;          // of the poses that are kept: more, and the tip did not stand
  double inliers_min = 0.5;         // of all poses
};

inline constexpr int k_pivot_poses_min = 12;
// Fewer do not tell which noise is whose: they get plain least squares, and only what is off by
// three times the usual gate is left out.
inline constexpr int k_pivot_noise_poses_min = 30;

struct PivotResult {
  Vector3 tip_m = Vector3::Zero();   // tool frame
  Vector3 post_m = Vector3::Zero();  // where it stood, in the poses' frame
  Matrix3 tip_covariance_m2 = Matrix3::Zero();
  double tip_sigma_m = 0;       // of the direction that is known worst
  double rms_m = 0;             // of |R tip + t - post| over the poses that are kept
  double position_sigma_m = 0;  // the poses' noise an axis, as found
  double rotation_sigma_rad = 0;
  double correlated = 1;  // so many poses in a row tell no more than one
  RotationSpread spread;
  std::vector<double> distances_m;  // of each pose used: |R tip + t - post|
  std::vector<bool> kept;
  int poses_used = 0;  // of the series' beginning
  int outliers = 0;
  bool sigma_reached = true;  // where one was asked for
};

// Throws InputError, naming `what` (a file), for too few poses, motion that leaves a direction of
// the tip open (which), or poses that do not turn about one point.
[[nodiscard]] PivotResult calibrate_pivot(std::span<const StampedPose> poses,
                                          const PivotSettings& settings, const std::string& what);

}  // namespace glint
