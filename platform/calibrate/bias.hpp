// The mean error of a tool held still, against a reference, as a constant correction with the
// range of distances and angles that it was measured at.
//
// Poses and reference are those of the same frame of the tool, in the camera's frame. Samples in
// motion are left out, for what trails is no bias; so are the wild ones. Successive samples that
// repeat each other count as one.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "kernels/motion/interpolate.hpp"
#include "kernels/pose/bias_correction.hpp"

namespace glint {

struct BiasSettings {
  CorrectionFrame frame = CorrectionFrame::tool;
  double gap_max_s = 0.1;       // longer gaps of the reference are left out
  double speed_max_m_s = 0.01;  // of the reference: faster is motion
  double turn_max_rad_s = 0.1;  // ~ 6 deg/s
  double inliers_min = 0.5;     // of the samples at rest
  double sigmas_min = 3;        // less than so many of its own sigmas is no error
  double margin_m = 0.02;       // of what was seen, to both sides: a hand is not a vice
  double margin_rad = 0.05;     // 3 deg
};

inline constexpr int k_bias_samples_min = 30;

struct BiasResult {
  BiasCorrection correction;
  ValidRange off_axis_rad, tilt_rad;  // the same as in the correction, as angles
  Vector3 shift_sigma_m = Vector3::Zero();
  Vector3 turn_sigma_rad = Vector3::Zero();
  double correlated = 1;                     // so many samples in a row tell no more than one
  double rms_before_m = 0, rms_after_m = 0;  // of the samples kept
  double rms_before_rad = 0, rms_after_rad = 0;
  std::vector<double> distances_m;  // of each sample at rest, corrected
  std::vector<bool> kept;
  int samples = 0, moving = 0, outliers = 0;
};

// Both series on one time axis. Throws InputError, naming `what`, for too few samples, a tool that
// moves, errors that do not agree, or a mean that is no more than chance (nothing to correct).
[[nodiscard]] BiasResult calibrate_bias(std::span<const StampedPose> poses,
                                        std::span<const StampedPose> reference,
                                        const BiasSettings& settings, const std::string& what);

}  // namespace glint
