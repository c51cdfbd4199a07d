// Pivot calibration: tool tip position from poses while the tip rests in a dent and the tool
// rotates.
//
// Initial guess: linear least squares of R_i tip + t_i = post with Huber weights (Huber 1964)
// against outliers. Its residuals along and across the lever arm separate position noise from
// rotation noise. Refinement: Ceres with each frame's true rotation as an unknown
// (kernels/calibrate/pivot_residual.hpp) and a Cauchy loss; then outliers are removed and the fit
// is repeated without loss.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "kernels/motion/interpolate.hpp"
#include "platform/tools/calibrate/rotation_spread.hpp"

namespace glint {

struct PivotSettings {
  // Point of the tool whose position noise is independent of the rotation noise: the centroid of
  // its markers. The origin if unknown.
  Vector3 centre_m = Vector3::Zero();
  double scale_sigma = 0;           // of all positions, a ratio: scales the tip along the lever arm
  double stop_sigma_m = 0;          // stop when the tip's sigma is below; 0: use every pose
  double spread_min_rad = 0.05;     // of each tool direction; less leaves the tip open along it
  double inlier_chi_square = 16.3;  // of 3 components: rejects one valid pose in 1000
  double rms_max_m = 0.02;          // of the kept poses; above it the tip moved
  double inliers_min = 0.5;         // share of all poses
};

inline constexpr int k_pivot_poses_min = 12;
// Fewer poses do not separate position noise from rotation noise: they get plain least squares, and
// the outlier limit is three times the usual one.
inline constexpr int k_pivot_noise_poses_min = 30;

struct PivotResult {
  Vector3 tip_m = Vector3::Zero();   // tool frame
  Vector3 post_m = Vector3::Zero();  // the tip's position in the poses' frame
  Matrix3 tip_covariance_m2 = Matrix3::Zero();
  double tip_sigma_m = 0;       // in the least certain direction
  double rms_m = 0;             // of |R tip + t - post| over the kept poses
  double position_sigma_m = 0;  // estimated noise of the poses, per axis
  double rotation_sigma_rad = 0;
  double variance_inflation = 1;  // by autocorrelation
  RotationSpread spread;
  std::vector<double> distances_m;  // of each pose used: |R tip + t - post|
  std::vector<bool> kept;
  int poses_used = 0;  // from the beginning of the series
  int outliers = 0;
  bool sigma_reached = true;  // also true if no limit was set
};

// Throws InputError, naming `what` (a file), for too few poses, for motion that leaves a direction
// of the tip undetermined (names it), and for poses that do not rotate about one point.
[[nodiscard]] PivotResult calibrate_pivot(std::span<const TimedPose> poses,
                                          const PivotSettings& settings, const std::string& what);

}  // namespace glint
