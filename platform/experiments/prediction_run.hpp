// A recording measured with noise at a steady rate, and how far a predictor is off.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "platform/experiments/predictor.hpp"
#include "platform/sensors/trajectory.hpp"

namespace glint {

struct PredictionSettings {
  Duration period{22'222'222};  // 45 Hz
  double position_sigma_m = 0.0005;
  double rotation_sigma_rad = 0.3 * 3.14159265358979323846 / 180;
  Duration warm_up = milliseconds(1000);  // not judged, and not after a gap of the recording
};

struct NoisyRecording {
  Trajectory truth;
  std::vector<UncertainPose> measured;
};

// Whether a measurement may be judged: a second after the begin and after each gap of the
// recording.
class Judged {
 public:
  explicit Judged(Duration warm_up) : warm_up_(warm_up), from_(Time{} + warm_up) {}
  // Each measurement's time in turn.
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

// One pass over the recording; the errors at each horizon after every measurement that a recorded
// sample stands near to.
[[nodiscard]] std::vector<PredictionError> prediction_errors(const NoisyRecording& recording,
                                                             Predictor& predictor,
                                                             const std::vector<Duration>& horizons,
                                                             const PredictionSettings& settings);

}  // namespace glint
