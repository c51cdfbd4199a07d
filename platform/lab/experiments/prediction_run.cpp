#include "platform/lab/experiments/prediction_run.hpp"

#include <algorithm>
#include <cmath>

#include "platform/sim/random.hpp"

namespace glint {
namespace {

// Ground truth is valid only between recorded samples that are at most this far apart.
constexpr Duration k_gap_max = milliseconds(100);

bool has_ground_truth(const Trajectory& truth, Time time) {
  const auto& samples = truth.samples;
  const auto after =
      std::lower_bound(samples.begin(), samples.end(), time,
                       [](const TimedPose& sample, Time t) { return sample.time < t; });
  if (after == samples.begin() || after == samples.end()) return false;
  return after->time - (after - 1)->time <= k_gap_max;
}

}  // namespace

bool EvaluationWindow::operator()(Time time) {
  if (time - last_ > k_gap_max) from_ = time + warm_up_;
  last_ = time;
  return time >= from_;
}

NoisyRecording noisy(Trajectory truth, const PredictionSettings& settings, std::uint64_t seed) {
  NoisyRecording recording;
  recording.truth = std::move(truth);
  const sim::RandomKey shift{seed, sim::Stream::blob, 0}, turn{seed, sim::Stream::blob, 1};
  const double pp = settings.position_sigma_m * settings.position_sigma_m;
  const double rr = settings.rotation_sigma_rad * settings.rotation_sigma_rad;
  std::uint64_t frame = 0;
  for (Time t; t <= Time{recording.truth.length().nanoseconds}; t = t + settings.period, ++frame) {
    if (!has_ground_truth(recording.truth, t)) continue;
    UncertainPose measured;
    measured.time = t;
    const Pose pose = interpolated(recording.truth, t);
    measured.pose.translation =
        pose.translation + settings.position_sigma_m * sim::gaussian_vector(shift, frame);
    measured.pose.rotation =
        (from_rotation_vector(settings.rotation_sigma_rad * sim::gaussian_vector(turn, frame)) *
         pose.rotation)
            .normalized();
    measured.covariance.diagonal() << pp, pp, pp, rr, rr, rr;
    recording.measured.push_back(measured);
  }
  return recording;
}

std::vector<PredictionError> prediction_errors(const NoisyRecording& recording,
                                               Predictor& predictor,
                                               const std::vector<Duration>& horizons,
                                               const PredictionSettings& settings) {
  std::vector<PredictionError> errors(horizons.size());
  EvaluationWindow is_evaluated(settings.warm_up);
  for (const UncertainPose& measured : recording.measured) {
    predictor.update(measured);
    if (!is_evaluated(measured.time)) continue;
    for (std::size_t h = 0; h < horizons.size(); ++h) {
      const Time target = measured.time + horizons[h];
      if (!has_ground_truth(recording.truth, target)) continue;
      const Pose truth = interpolated(recording.truth, target);
      const Pose predicted = predictor.predict(target);
      errors[h].position_rms_m += (predicted.translation - truth.translation).squaredNorm();
      errors[h].rotation_rms_rad +=
          rotation_vector(predicted.rotation * truth.rotation.conjugate()).squaredNorm();
      ++errors[h].n;
    }
  }
  for (PredictionError& error : errors) {
    error.position_rms_m = std::sqrt(error.position_rms_m / std::max(error.n, 1));
    error.rotation_rms_rad = std::sqrt(error.rotation_rms_rad / std::max(error.n, 1));
  }
  return errors;
}

}  // namespace glint
