#include <algorithm>
#include <array>
#include <string>

#include "kernels/angles.hpp"
#include "platform/lab/experiments/baselines.hpp"
#include "platform/lab/experiments/estimator_settings.hpp"
#include "platform/lab/experiments/glint_predictor.hpp"
#include "platform/lab/experiments/motion_experiments.hpp"
#include "platform/lab/experiments/prediction_run.hpp"
#include "platform/lab/experiments/recordings.hpp"

namespace glint {
namespace {

constexpr std::array<const char*, 2> k_ahead = {"25 ms", "50 ms"};
const std::vector<Duration> k_horizons = {milliseconds(25), milliseconds(50)};

// Limits of Glint's error relative to linear + SLERP and to the best baseline predictor.
struct ErrorRatios {
  double position_of_linear, rotation_of_linear;
  double position_of_best, rotation_of_best;
};
constexpr std::array<ErrorRatios, k_recordings.size()> k_error_ratios = {
    {{0.70, 0.58, 0.93, 1.08},
     {0.70, 0.58, 0.93, 1.00},
     {0.80, 0.58, 0.93, 1.02},
     {0.70, 0.70, 0.93, 1.00}}};

const std::vector<NamedPredictor>& rivals() {
  static const std::vector<NamedPredictor> k_rivals = {
      {"linear + SLERP", [] { return make_linear_slerp(); }},
      {"last value", [] { return make_last_value(); }},
      {"one euro", [] { return make_one_euro(); }},
      {"double exponential", [] { return make_double_exponential(); }},
      {"constant velocity", [] { return make_constant_velocity(); }}};
  return k_rivals;
}

using HorizonErrors = std::array<PredictionError, k_ahead.size()>;  // one per horizon

ExperimentCase case_of(const char* recording, std::size_t h, const std::string& method,
                       const HorizonErrors& errors) {
  return {std::string(recording) + ", " + k_ahead[h],
          method,
          errors[h].n,
          {{"position_rms", "mm", 1000 * errors[h].position_rms_m, {}},
           {"rotation_rms", "deg", k_degrees_per_radian * errors[h].rotation_rms_rad, {}}}};
}

void add_ratios(ExperimentCase& glint, const ErrorRatios& ratios, const PredictionError& own,
                const std::vector<HorizonErrors>& others, std::size_t h, bool judged) {
  double position = others[0][h].position_rms_m, rotation = others[0][h].rotation_rms_rad;
  const auto bar = [&](double limit) { return judged ? Bar::at_most(limit) : Bar::none(); };
  glint.figures.push_back(
      {"position_of_linear", "", own.position_rms_m / position, bar(ratios.position_of_linear)});
  glint.figures.push_back(
      {"rotation_of_linear", "", own.rotation_rms_rad / rotation, bar(ratios.rotation_of_linear)});
  for (const HorizonErrors& other : others) {
    position = std::min(position, other[h].position_rms_m);
    rotation = std::min(rotation, other[h].rotation_rms_rad);
  }
  glint.figures.push_back(
      {"position_of_best", "", own.position_rms_m / position, bar(ratios.position_of_best)});
  glint.figures.push_back(
      {"rotation_of_best", "", own.rotation_rms_rad / rotation, bar(ratios.rotation_of_best)});
}

}  // namespace

CaseList run_prediction(const CaseOptions& options) {
  CaseList list{"prediction", {}, {}};
  const PredictionSettings settings;
  const std::vector<Trajectory> truths = load_recordings(options);
  for (std::size_t i = 0; i < truths.size(); ++i) {
    const NoisyRecording measured = noisy(truths[i], settings, options.seed);
    const auto errors_of = [&](Predictor& predictor) {
      return options.piece([&] {
        const auto found = prediction_errors(measured, predictor, k_horizons, settings);
        HorizonErrors errors;
        std::copy(found.begin(), found.end(), errors.begin());
        return errors;
      });
    };
    GlintPredictor glint(EstimatorSettings{}.motion);
    const HorizonErrors own = errors_of(glint);
    std::vector<HorizonErrors> others;
    for (const NamedPredictor& rival : rivals()) others.push_back(errors_of(*rival.make()));
    for (std::size_t h = 0; h < k_horizons.size(); ++h) {
      list.cases.push_back(case_of(k_recordings[i].name, h, "glint", own));
      add_ratios(list.cases.back(), k_error_ratios[i], own[h], others, h, !options.quick);
      for (std::size_t k = 0; k < others.size(); ++k)
        list.cases.push_back(case_of(k_recordings[i].name, h, rivals()[k].name, others[k]));
    }
    if (options.progress)
      options.progress(static_cast<int>(i) + 1, static_cast<int>(truths.size()));
  }
  return list;
}

}  // namespace glint
