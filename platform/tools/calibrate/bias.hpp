// Constant bias correction of a static tool's poses against a reference, with the interval of
// distances and angles of the data.
//
// Poses and reference are of the same tool frame, in the camera's frame. Samples in motion are
// skipped, since delay is not bias; outliers are removed. The standard deviations account for the
// autocorrelation of successive samples.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "kernels/motion/interpolate.hpp"
#include "kernels/pose/bias_correction.hpp"

namespace glint {

struct BiasSettings {
  CorrectionFrame frame = CorrectionFrame::tool;
  double gap_max_s = 0.1;                // longer gaps of the reference are skipped
  double speed_max_m_s = 0.01;           // of the reference; faster is motion
  double angular_speed_max_rad_s = 0.1;  // ~ 6 deg/s
  double inliers_min = 0.5;              // share of the static samples
  double sigmas_min = 3;                 // a smaller mean, in its own sigmas, is not significant
  double margin_m = 0.02;    // added to the observed interval on both sides, for hand-held tools
  double margin_rad = 0.05;  // 3 deg
};

inline constexpr int k_bias_samples_min = 30;

struct BiasResult {
  BiasCorrection correction;
  ValidRange off_axis_rad, tilt_rad;  // as in the correction, but as angles
  Vector3 translation_sigma_m = Vector3::Zero();
  Vector3 rotation_sigma_rad = Vector3::Zero();
  double variance_inflation = 1;             // by autocorrelation
  double rms_before_m = 0, rms_after_m = 0;  // of the kept samples
  double rms_before_rad = 0, rms_after_rad = 0;
  std::vector<double> distances_m;  // of each static sample, corrected
  std::vector<bool> kept;
  int samples = 0, moving = 0, outliers = 0;
};

// Both series are on one time axis. Throws InputError, naming `what`, for too few samples, a moving
// tool, errors that disagree, and a mean that is not significant (nothing to correct).
[[nodiscard]] BiasResult calibrate_bias(std::span<const TimedPose> poses,
                                        std::span<const TimedPose> reference,
                                        const BiasSettings& settings, const std::string& what);

}  // namespace glint
