// Maximum-likelihood calibration of the hand motion model: noise density and damping of its
// acceleration, for translation and rotation.
//
// The unknowns are the logarithms; the measurement noise of the recordings is declared
// (motion_likelihood.hpp). The last third of each recording is held out. There the likelihood and
// the prediction error are reported beside those of the built-in setting.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "platform/formats/trajectory.hpp"
#include "platform/tools/calibrate/motion_likelihood.hpp"

namespace glint {

enum class AddedNoise { none, declared };

struct MotionCalibrationSettings {
  MeasuredNoise noise;
  // declared: the recordings are ground truth; the declared noise is added to them first.
  AddedNoise added = AddedNoise::none;
  double rate_hz = 45;          // faster samples are skipped
  double gap_max_s = 0.5;       // the filter restarts after a longer gap
  MotionSettings start;         // initial guess, and the setting that the result is compared with
  double log_sigma_max = 1.5;   // of each unknown; above it the motion leaves the unknown open
  double motion_gain_min = 20;  // log-likelihood ratio to a nearly static tool
  std::uint64_t seed = 1;
  std::function<void(int evaluations)> progress;  // may be empty
};

inline constexpr int k_motion_samples_min = 300;

struct MotionError {
  double position_rms_m = 0, rotation_rms_rad = 0;
  int n = 0;
};

// Errors of one setting on the held-out part.
struct HeldOut {
  double log_likelihood = 0;  // per measurement, translation plus rotation
  MotionError at_25_ms, at_50_ms;
};

struct MotionCalibration {
  MotionSettings motion;
  // Covariances of (ln noise, ln damping).
  Eigen::Matrix2d translation_covariance = Eigen::Matrix2d::Zero();
  Eigen::Matrix2d rotation_covariance = Eigen::Matrix2d::Zero();
  HeldOut found, built_in;
  std::vector<double> errors_m;  // prediction error 25 ms ahead, on the held-out part
  int samples = 0, held_out = 0;
};

// Throws InputError, naming `what`, for recordings that are too short or that leave a part
// undetermined (names the part and the motion needed).
[[nodiscard]] MotionCalibration calibrate_motion(std::span<const Trajectory> recordings,
                                                 const MotionCalibrationSettings& settings,
                                                 const std::string& what);

}  // namespace glint
