// Where one tracker's frame lies in another's, from the same tool's motion seen by both: the rigid
// transform between the frames, the one between the tool and the reference's body (lever arm), and
// by how much the clocks differ.
//
// Start: for each offset on a grid, both rotations and then both translations in closed form; the
// least median distance counts. Then Ceres with a Cauchy loss (kernels/calibrate/
// align_residual.hpp), outliers removed, without loss again.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "kernels/calibrate/align_residual.hpp"
#include "kernels/motion/interpolate.hpp"
#include "platform/calibrate/rotation_spread.hpp"

namespace glint {

enum class LeverArm { unknown, none };  // none: both see the tool's own frame

struct AlignSettings {
  LeverArm lever_arm = LeverArm::unknown;
  double offset_max_s = 0.5;         // searched on both sides of 0
  double spread_min_rad = 0.1;       // moved less, a direction's lever arm is a guess
  double offset_contrast_min = 1.1;  // how much worse a shifted series must fit
  double gap_max_s = 0.1;            // longer gaps of the reference are left out
  double inliers_min = 0.5;
};

inline constexpr int k_align_samples_min = 30;

struct AlignResult {
  Pose T_reference_file;        // of the poses' frame in the reference's
  Pose T_tool_body;             // of the reference's body in the tool's frame
  double offset_s = 0;          // the reference's stamp of an instant, less the poses' stamp
  double position_sigma_m = 0;  // of T_reference_file, the worst direction
  double rotation_sigma_rad = 0;
  double lever_sigma_m = 0;
  double offset_sigma_s = 0;
  double offset_contrast = 0;
  double rms_m = 0, rms_rad = 0;  // of what is kept
  RotationSpread spread;
  std::vector<double> distances_m;  // of each sample
  std::vector<bool> kept;
  int samples = 0, outliers = 0;
};

// Both series on one time axis. Throws InputError, naming `what`, for too little overlap, motion
// that leaves a direction or the offset open (which), or series that do not belong together.
[[nodiscard]] AlignResult align_series(std::span<const StampedPose> poses,
                                       std::span<const StampedPose> reference,
                                       const AlignSettings& settings, const std::string& what);

}  // namespace glint
