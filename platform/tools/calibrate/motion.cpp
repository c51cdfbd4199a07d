#include "platform/tools/calibrate/motion.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/motion/predict_motion.hpp"
#include "kernels/motion/tool_motion.hpp"
#include "platform/input_error.hpp"
#include "platform/sim/random.hpp"
#include "platform/tools/calibrate/figure_text.hpp"
#include "platform/tools/calibrate/motion_fit.hpp"

namespace glint {
namespace {

constexpr double k_spacing_min = 0.9;  // minimum spacing of kept samples, in periods
constexpr double k_fit_part = 2.0 / 3;
constexpr double k_slow_noise_factor = 1e-3;
constexpr double k_static_noise_factor = 1e-4;      // of the initial noise: nearly static
constexpr Duration k_warm_up = milliseconds(1000);  // of the predictor; not evaluated
constexpr Duration k_truth_gap_max = milliseconds(100);

std::vector<TimedPose> subsampled(const Trajectory& recording, double rate_hz) {
  std::vector<TimedPose> samples;
  for (const TimedPose& sample : recording.samples) {
    if (samples.empty() || (sample.time - samples.back().time).seconds() * rate_hz >= k_spacing_min)
      samples.push_back(sample);
  }
  return samples;
}

void add_noise(std::vector<TimedPose>& samples, const MeasuredNoise& noise, std::uint64_t seed,
               std::uint64_t recording) {
  const sim::RandomKey shift{seed, sim::Stream::blob, 2 * recording};
  const sim::RandomKey turn{seed, sim::Stream::blob, 2 * recording + 1};
  for (std::size_t i = 0; i < samples.size(); ++i) {
    Pose& pose = samples[i].pose;
    pose.translation += noise.position_sigma_m * sim::gaussian_vector(shift, i);
    pose.rotation =
        (from_rotation_vector(noise.rotation_sigma_rad * sim::gaussian_vector(turn, i)) *
         pose.rotation)
            .normalized();
  }
}

bool recorded_near(const Trajectory& truth, Time time) {
  const auto& samples = truth.samples;
  const auto after =
      std::lower_bound(samples.begin(), samples.end(), time,
                       [](const TimedPose& sample, Time t) { return sample.time < t; });
  if (after == samples.begin() || after == samples.end()) return false;
  return after->time - (after - 1)->time <= k_truth_gap_max;
}

// Sums of squared prediction errors over one recording's held-out part.
class PredictionErrors {
 public:
  PredictionErrors(const Trajectory& truth, const MotionSettings& motion,
                   const MeasuredNoise& noise)
      : truth_(truth), noise_(noise) {
    motion_.settings.motion = motion;
  }

  void take(const TimedPose& measured, HeldOut& out, std::vector<double>* errors_m) {
    UncertainPose pose{measured.time, measured.pose, Matrix6::Zero()};
    const double p = noise_.position_sigma_m * noise_.position_sigma_m;
    const double r = noise_.rotation_sigma_rad * noise_.rotation_sigma_rad;
    pose.covariance.diagonal() << p, p, p, r, r, r;
    if (!begun_ || measured.time - last_ > k_truth_gap_max) from_ = measured.time + k_warm_up;
    begun_ = true;
    last_ = measured.time;
    if (motion_.update(pose) != Reason::none || measured.time < from_) return;
    const double miss = add(measured.time + milliseconds(25), out.at_25_ms);
    if (errors_m != nullptr && miss >= 0) errors_m->push_back(miss);
    (void)add(measured.time + milliseconds(50), out.at_50_ms);
  }

 private:
  // Returns the distance between prediction and ground truth; -1 if there is no ground truth near.
  double add(Time time, MotionError& error) {
    if (!recorded_near(truth_, time)) return -1;
    const Pose truth = interpolated(truth_, time);
    const Pose predicted =
        predict_pose(motion_.estimate(), time, motion_.settings.motion, motion_.noise_scale()).pose;
    const double miss = (predicted.translation - truth.translation).norm();
    error.position_rms_m += miss * miss;
    error.rotation_rms_rad +=
        rotation_vector(predicted.rotation * truth.rotation.conjugate()).squaredNorm();
    ++error.n;
    return miss;
  }

  const Trajectory& truth_;
  MeasuredNoise noise_;
  ToolMotion motion_;
  bool begun_ = false;
  Time last_, from_;
};

MotionUnknowns unknowns_of(const MotionSettings& motion, MotionPart part) {
  return part == MotionPart::shift
             ? MotionUnknowns{motion.linear_noise_m2_s5, motion.linear_damping_1_s}
             : MotionUnknowns{motion.angular_noise_rad2_s5, motion.angular_damping_1_s};
}

HeldOut held_out_errors(std::span<const Trajectory> recordings, const MotionSeries& held_out,
                        const MotionSettings& motion, const LikelihoodSettings& likelihood,
                        std::vector<double>* errors_m) {
  HeldOut out;
  for (std::size_t i = 0; i < held_out.size(); ++i) {
    PredictionErrors judge(recordings[i], motion, likelihood.noise);
    for (const TimedPose& sample : held_out[i]) judge.take(sample, out, errors_m);
  }
  for (MotionError* error : {&out.at_25_ms, &out.at_50_ms}) {
    error->position_rms_m = std::sqrt(error->position_rms_m / std::max(error->n, 1));
    error->rotation_rms_rad = std::sqrt(error->rotation_rms_rad / std::max(error->n, 1));
  }
  for (const MotionPart part : {MotionPart::shift, MotionPart::rotation}) {
    const Likelihood found = likelihood_of(held_out, part, unknowns_of(motion, part), likelihood);
    out.log_likelihood += found.log_likelihood / std::max(1, found.innovations);
  }
  return out;
}

const char* name_of(MotionPart part) { return part == MotionPart::shift ? "shift" : "rotation"; }

[[noreturn]] void refuse(const std::string& what, MotionPart part, const std::string& open,
                         const std::string& expected) {
  throw InputError(what + ": the motion does not determine the " + name_of(part) + "'s " + open +
                   "; expected " + expected +
                   ": record a minute or more of typical work, with starts, stops and " +
                   "turns, and declare the noise of these poses");
}

// Returns whether a nearly static tool is as likely, or a still slower one likelier.
bool is_static(const MotionSeries& series, MotionPart part, const MotionUnknowns& start,
               const LikelihoodSettings& likelihood, double gain_min) {
  const Likelihood still =
      likelihood_of(series, part, {k_static_noise_factor * start.noise, start.damping}, likelihood);
  const Likelihood moving =
      likelihood_of(series, part, {k_slow_noise_factor * start.noise, start.damping}, likelihood);
  return still.gradient[0] < 0 || moving.log_likelihood < still.log_likelihood + gain_min;
}

MotionFit fitted(const MotionSeries& series, MotionPart part,
                 const MotionCalibrationSettings& settings, const LikelihoodSettings& likelihood,
                 const std::function<void()>& evaluated, const std::string& what) {
  const MotionUnknowns start = unknowns_of(settings.start, part);
  if (is_static(series, part, start, likelihood, settings.motion_gain_min)) {
    refuse(what, part, "noise and damping", "motion above the declared noise");
  }
  const MotionFit fit = maximise_likelihood(series, part, start, likelihood, evaluated);
  if (!fit.determined) {
    refuse(what, part, "noise and damping", "a likelihood that has a maximum");
  }
  const double worst = std::sqrt(fit.covariance.diagonal().maxCoeff());
  if (worst > settings.log_sigma_max) {
    refuse(what, part,
           std::string(fit.covariance(0, 0) > fit.covariance(1, 1) ? "noise" : "damping") +
               ": its logarithm has a standard deviation of " + format_number("%.2g", worst),
           "at most " + format_number("%.2g", settings.log_sigma_max));
  }
  return fit;
}

}  // namespace

MotionCalibration calibrate_motion(std::span<const Trajectory> recordings,
                                   const MotionCalibrationSettings& settings,
                                   const std::string& what) {
  MotionCalibration result;
  MotionSeries fit_on, held_out;
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    std::vector<TimedPose> samples = subsampled(recordings[i], settings.rate_hz);
    if (settings.added == AddedNoise::declared)
      add_noise(samples, settings.noise, settings.seed, i);
    const auto split = samples.begin() + static_cast<std::ptrdiff_t>(
                                             k_fit_part * static_cast<double>(samples.size()));
    fit_on.emplace_back(samples.begin(), split);
    held_out.emplace_back(split, samples.end());
    result.samples += static_cast<int>(fit_on.back().size());
    result.held_out += static_cast<int>(held_out.back().size());
  }
  if (result.samples < k_motion_samples_min) {
    throw InputError(what + ": " + std::to_string(result.samples + result.held_out) + " poses at " +
                     format_number("%.3g Hz", settings.rate_hz) + "; expected at least " +
                     std::to_string(k_motion_samples_min * 3 / 2) +
                     ", one third of them for validation: record for longer");
  }
  const LikelihoodSettings likelihood{settings.noise, settings.start, settings.gap_max_s};
  int evaluations = 0;
  const std::function<void()> evaluated = [&] {
    if (settings.progress) settings.progress(++evaluations);
  };
  const MotionFit shift = fitted(fit_on, MotionPart::shift, settings, likelihood, evaluated, what);
  const MotionFit rotation =
      fitted(fit_on, MotionPart::rotation, settings, likelihood, evaluated, what);
  result.motion = settings.start;
  result.motion.linear_noise_m2_s5 = shift.unknowns.noise;
  result.motion.linear_damping_1_s = shift.unknowns.damping;
  result.motion.angular_noise_rad2_s5 = rotation.unknowns.noise;
  result.motion.angular_damping_1_s = rotation.unknowns.damping;
  result.translation_covariance = shift.covariance;
  result.rotation_covariance = rotation.covariance;
  result.found = held_out_errors(recordings, held_out, result.motion, likelihood, &result.errors_m);
  result.built_in = held_out_errors(recordings, held_out, settings.start, likelihood, nullptr);
  return result;
}

}  // namespace glint
