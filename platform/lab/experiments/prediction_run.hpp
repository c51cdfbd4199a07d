// Noisy measurements of a recorded motion at a constant rate, and errors of a predictor on them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "platform/formats/trajectory.hpp"
#include "platform/lab/experiments/predictor.hpp"

namespace glint {

struct PredictionSettings {
  Duration period{22'222'222};  // 45 Hz
  double position_sigma_m = 0.0005;
  double rotation_sigma_rad = 0.3 * 3.14159265358979323846 / 180;
  Duration warm_up = milliseconds(1000);  // not judged, at the start and after each gap
};

struct NoisyRecording {
  Trajectory truth;
  std::vector<UncertainPose> measured;
};

// Whether a measurement is judged: from `warm_up` on after the start and after each gap of the
// recording.
class EvaluationWindow {
 public:
  explicit EvaluationWindow(Duration warm_up) : warm_up_(warm_up), from_(Time{} + warm_up) {}
  // Call with the time of each measurement, in order.
  [[nodiscard]] bool operator()(Time time);

 private:
  Duration warm_up_;
  Time last_, from_;
};

[[nodiscard]] NoisyRecording noisy(Trajectory truth, const PredictionSettings& settings,
                                   std::uint64_t seed);

struct PredictionError {
  double position_rms_m = 0;    // of the length of the error
  double rotation_rms_rad = 0;  // of its angle
  int n = 0;
};

// Runs the predictor over the recording once. Returns the errors at each horizon, over the judged
// measurements for which the predicted time is near recorded samples.
[[nodiscard]] std::vector<PredictionError> prediction_errors(const NoisyRecording& recording,
                                                             Predictor& predictor,
                                                             const std::vector<Duration>& horizons,
                                                             const PredictionSettings& settings);

}  // namespace glint
