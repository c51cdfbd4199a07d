// Spatiotemporal alignment of two trackers (hand-eye calibration) from motion of one tool that both
// observe: rigid transform between their frames, rigid transform from the tool to the reference's
// body (lever arm), and clock offset.
//
// Initial guess: for each clock offset on a grid, both rotations and then both translations in
// closed form; the offset with the least median distance. Refinement: Ceres with a Cauchy loss
// (kernels/calibrate/align_residual.hpp); then outliers are removed and the fit is repeated without
// loss.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "kernels/calibrate/align_residual.hpp"
#include "kernels/motion/interpolate.hpp"
#include "platform/tools/calibrate/rotation_spread.hpp"

namespace glint {

enum class LeverArm { unknown, none };  // none: both trackers report the tool's own frame

struct AlignSettings {
  LeverArm lever_arm = LeverArm::unknown;
  double offset_max_s = 0.5;         // searched on both sides of 0
  double spread_min_rad = 0.1;       // below it a direction's lever arm is undetermined
  double offset_contrast_min = 1.1;  // required ratio of misfit: shifted series to aligned series
  double gap_max_s = 0.1;            // longer gaps of the reference are skipped
  double inliers_min = 0.5;
};

inline constexpr int k_align_samples_min = 30;

struct AlignResult {
  Pose T_reference_file;        // of the poses' frame in the reference's
  Pose T_tool_body;             // of the reference's body in the tool's frame
  double offset_s = 0;          // reference's time stamp of an instant, less the poses' time stamp
  double position_sigma_m = 0;  // of T_reference_file, least certain direction
  double rotation_sigma_rad = 0;
  double lever_sigma_m = 0;
  double offset_sigma_s = 0;
  double offset_contrast = 0;
  double rms_m = 0, rms_rad = 0;  // of the kept samples
  RotationSpread spread;
  std::vector<double> distances_m;  // of each sample
  std::vector<bool> kept;
  int samples = 0, outliers = 0;
};

// Both series are on one time axis. Throws InputError, naming `what`, for too little overlap, for
// motion that leaves a direction or the offset undetermined (names it), and for series of different
// motions.
[[nodiscard]] AlignResult align_series(std::span<const TimedPose> poses,
                                       std::span<const TimedPose> reference,
                                       const AlignSettings& settings, const std::string& what);

}  // namespace glint
