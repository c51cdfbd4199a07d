// How a hand moves, for the filter and the prediction: the density of the noise that drives its
// acceleration and the rate at which this fades, of shift and of rotation, by maximum likelihood of
// recordings with a declared measurement noise (motion_likelihood.hpp), on their logarithms.
//
// The last third of each recording is held out: there the likelihood and the prediction's error
// stand beside the built-in setting's.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "platform/calibrate/motion_likelihood.hpp"
#include "platform/sensors/trajectory.hpp"

namespace glint {

enum class AddedNoise { none, declared };

struct MotionCalibrationSettings {
  MeasuredNoise noise;
  // declared: the recordings are the truth, and are measured with the declared noise first.
  AddedNoise added = AddedNoise::none;
  double rate_hz = 45;          // samples that come faster are left out
  double gap_max_s = 0.5;       // after a longer gap the filter starts anew
  MotionSettings start;         // of the search, and what the result is held against
  double log_sigma_max = 1.5;   // of each unknown: more, and the motion left it open
  double motion_gain_min = 20;  // of the log-likelihood, over a tool that hardly moves
  std::uint64_t seed = 1;
  std::function<void(int evaluations)> progress;  // may be empty
};

inline constexpr int k_motion_samples_min = 300;

struct MotionError {
  double position_rms_m = 0, rotation_rms_rad = 0;
  int n = 0;
};

// Of one setting, on what was held out.
struct HeldOut {
  double log_likelihood = 0;  // a measurement, shift and rotation together
  MotionError at_25_ms, at_50_ms;
};

struct MotionCalibration {
  MotionSettings motion;
  // Of ln noise and ln damping: shift, rotation.
  Eigen::Matrix2d shift_covariance = Eigen::Matrix2d::Zero();
  Eigen::Matrix2d rotation_covariance = Eigen::Matrix2d::Zero();
  HeldOut found, built_in;
  std::vector<double> misses_m;  // of the prediction 25 ms ahead, on what was held out
  int samples = 0, held_out = 0;
};

// Throws InputError, naming `what`, for recordings that are too short or leave a part open: which,
// and how to move.
[[nodiscard]] MotionCalibration calibrate_motion(std::span<const Trajectory> recordings,
                                                 const MotionCalibrationSettings& settings,
                                                 const std::string& what);

}  // namespace glint
