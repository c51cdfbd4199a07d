#include <string>

#include "platform/lab/experiments/consistency.hpp"
#include "platform/lab/experiments/estimator_settings.hpp"
#include "platform/lab/experiments/motion_experiments.hpp"
#include "platform/lab/experiments/point_fit.hpp"
#include "platform/lab/experiments/prediction_run.hpp"
#include "platform/lab/experiments/recordings.hpp"
#include "platform/sim/random.hpp"

namespace glint {
namespace {

// In each second of the recording all markers but one or two are occluded for a while.
constexpr std::size_t k_cycle_frames = 45, k_gap_frames = 9;          // 1 s, 0.2 s
constexpr double k_across_sigma_m = 0.0002, k_along_sigma_m = 0.001;  // of a marker, along z

struct Gap {
  std::size_t first = 0, markers = 1, hidden_from = 0;
  [[nodiscard]] bool contains(std::size_t frame) const {
    return frame >= first && frame < first + k_gap_frames;
  }
};

// Not within the first fifth of its second, so that the filter has converged again.
Gap gap_of(std::uint64_t seed, std::size_t cycle) {
  const sim::RandomKey key{seed, sim::Stream::transport, 0};
  const std::size_t free_frames = k_cycle_frames - 2 * k_gap_frames;
  return {cycle * k_cycle_frames + k_gap_frames + key.bits(3 * cycle) % free_frames,
          1 + key.bits(3 * cycle + 1) % 2, key.bits(3 * cycle + 2)};
}

MeasuredPoint seen_marker(const Vector3& model, const Pose& truth, const Vector3& noise) {
  const Vector3 sigma(k_across_sigma_m, k_across_sigma_m, k_along_sigma_m);
  MeasuredPoint point;
  point.model_m = model;
  point.measured_m = truth * model + sigma.cwiseProduct(noise);
  point.covariance_m2.diagonal() = sigma.cwiseAbs2();
  return point;
}

struct Figures {
  Consistency hidden;
  int returns = 0, innovation_outliers = 0;

  void add(const Figures& other) {
    hidden.add(other.hidden);
    returns += other.returns;
    innovation_outliers += other.innovation_outliers;
  }
};

Figures follow(const NoisyRecording& recording, std::uint64_t seed) {
  Figures figures;
  const std::vector<Vector3> model = tool_8700339();
  ToolMotion motion;
  motion.settings = EstimatorSettings{}.motion;
  EvaluationWindow is_evaluated(PredictionSettings{}.warm_up);
  bool was_hidden = false;
  for (std::size_t frame = 0; frame < recording.measured.size(); ++frame) {
    const UncertainPose& measured = recording.measured[frame];
    const bool counts = is_evaluated(measured.time);
    if (!counts || !gap_of(seed, frame / k_cycle_frames).contains(frame)) {
      if (motion.update(measured) != Reason::none) continue;
      if (was_hidden && counts) {
        ++figures.returns;
        if (motion.last_correction().nis > k_inside_999) ++figures.innovation_outliers;
      }
      was_hidden = false;
      continue;
    }
    const Gap gap = gap_of(seed, frame / k_cycle_frames);
    const Pose truth = interpolated(recording.truth, measured.time);
    std::vector<MeasuredPoint> points;
    for (std::size_t i = 0; i < gap.markers; ++i) {
      const std::size_t marker = (gap.hidden_from + i) % model.size();
      const sim::RandomKey key{seed, sim::Stream::blob, 2 + i};
      points.push_back(seen_marker(model[marker], truth, sim::gaussian_vector(key, frame)));
    }
    if (motion.update(measured.time, points) != Reason::none) continue;
    figures.hidden.add(pose_of(motion.estimate()), truth);
    was_hidden = true;
  }
  return figures;
}

}  // namespace

CaseList run_occlusion(const CaseOptions& options) {
  CaseList list{"occlusion", {}, {}};
  const std::vector<Trajectory> truths = load_recordings(options);
  for (std::size_t i = 0; i < truths.size(); ++i) {
    Figures figures;
    const int draws = options.quick ? 1 : 10;
    for (int draw = 0; draw < draws; ++draw) {
      const std::uint64_t seed = options.seed * 1000 + static_cast<std::uint64_t>(draw);
      figures.add(options.piece(
          [&] { return follow(noisy(truths[i], PredictionSettings{}, seed), seed); }));
    }
    const auto bar = [&](Bar limit) { return options.quick ? Bar::none() : limit; };
    const double nees = figures.hidden.nees_per_axis();
    const double inside = figures.hidden.inside_95_percent();
    list.cases.push_back(
        {std::string(k_recordings[i].name) + ", 0.2 s with 1 or 2 markers",
         "glint",
         figures.hidden.n,
         {{"nees_over_6", "", nees, bar(Bar::at_most(1.4))},
          {"nees_over_6_least", "", nees, bar(Bar::at_least(0.7))},
          {"inside_95", "%", inside, bar(Bar::at_most(98))},
          {"inside_95_least", "%", inside, bar(Bar::at_least(92))},
          {"jump_on_return", "%", 100.0 * figures.innovation_outliers / figures.returns,
           bar(Bar::at_most(0.5))}}});
    if (options.progress)
      options.progress(static_cast<int>(i) + 1, static_cast<int>(truths.size()));
  }
  return list;
}

}  // namespace glint
