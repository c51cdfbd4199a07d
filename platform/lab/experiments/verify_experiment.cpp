#include "platform/lab/experiments/verify_experiment.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "platform/input_error.hpp"
#include "platform/lab/experiments/field_experiment.hpp"
#include "platform/lab/experiments/stated_errors.hpp"
#include "platform/sim/touches.hpp"
#include "platform/sources/scenario_of.hpp"
#include "platform/sources/simulated_source.hpp"
#include "platform/tools/verify/verification.hpp"

namespace glint {
namespace {

constexpr int k_devices = 25;      // per case
constexpr double k_wrong_max = 3;  // per case
constexpr double k_distance_sigma_m = 0.0001;

enum class Drawn { as_stated, below_one_sigma };

struct VerifyDevice {
  Drawn drawn;
  LargeError large = LargeError::nothing;
  std::uint64_t seed = 1;
};

constexpr std::array<LargeError, 5> k_large_errors = {
    LargeError::range_offset, LargeError::range_scale, LargeError::principal_point,
    LargeError::tool_geometry, LargeError::head_drift};
constexpr std::array<const char*, 5> k_large_names = {"wrong_range_offset", "wrong_range_scale",
                                                      "wrong_principal_point",
                                                      "wrong_tool_geometry", "wrong_head_drift"};

// Of a quick experiment: little more than `glint verify` requires.
sim::TouchSettings touches_of(const CaseOptions& options) {
  sim::TouchSettings out;
  if (options.quick) {
    out.touches = 15;
    out.hold_s = 1.6;
    out.move_s = 1;
    out.rest_s = 20;
  }
  return out;
}

sim::Scenario touching(const Cell& cell, const VerifyDevice& device,
                       const sim::TouchSettings& touches) {
  sim::Scenario scenario = scenario_of(cell);
  if (device.drawn == Drawn::below_one_sigma) {
    draw_below_one_sigma(cell, device.large, device.seed, scenario);
  } else {
    const double drift =
        scenario.localisation.rest_position_m / sim::LocalisationSettings{}.rest_position_m;
    set_drift_factor(std::min(drift, 1.0), scenario.localisation);
  }
  scenario.timing.slow.clear();
  scenario.occlusions.clear();
  scenario.absences.clear();
  sim::touch_points(touches, device.seed, scenario);
  return scenario;
}

// A rejected recording is neither verdict.
bool is_verdict(bool agrees, const VerifyDevice& device, const sim::TouchSettings& touches) {
  const Cell cell = field_cell(device.seed, touches.duration().seconds());
  const sim::Simulator simulator(touching(cell, device, touches));
  RecordedFrames recorded{"simulated touches", cell, std::make_unique<SimulatedSource>(simulator)};
  try {
    const TipSeries series = observe_tips(recorded, 0);
    return verify_touches(series, {touches.distance_m(), k_distance_sigma_m}).agrees == agrees;
  } catch (const InputError&) {
    return false;
  }
}

ExperimentCase agreeing(const char* name, Drawn drawn, int devices, const CaseOptions& options,
                        const std::function<void()>& step) {
  double wrong = 0;
  for (int i = 0; i < devices; ++i, step()) {
    const VerifyDevice device{drawn, LargeError::nothing,
                              options.seed + static_cast<std::uint64_t>(i)};
    wrong += options.piece([&] { return is_verdict(true, device, touches_of(options)); }) ? 0 : 1;
  }
  return {name,
          "glint",
          devices,
          {{"wrong_verdicts", "", wrong, options.quick ? Bar::none() : Bar::at_most(k_wrong_max)}}};
}

// Cycles through the kinds of error.
ExperimentCase disagreeing(int devices, const CaseOptions& options,
                           const std::function<void()>& step) {
  std::array<double, k_large_errors.size()> wrong{};
  double all = 0;
  for (int i = 0; i < devices; ++i, step()) {
    const auto kind = static_cast<std::size_t>(i) % k_large_errors.size();
    const VerifyDevice device{Drawn::below_one_sigma, k_large_errors[kind],
                              options.seed + static_cast<std::uint64_t>(i)};
    if (options.piece([&] { return is_verdict(false, device, touches_of(options)); })) continue;
    wrong[kind] += 1;
    all += 1;
  }
  ExperimentCase out{
      "one error of four sigma",
      "glint",
      devices,
      {{"wrong_verdicts", "", all, options.quick ? Bar::none() : Bar::at_most(k_wrong_max)}}};
  for (std::size_t kind = 0; kind < wrong.size(); ++kind)
    out.figures.push_back({k_large_names[kind], "", wrong[kind]});
  return out;
}

}  // namespace

CaseList run_verify_experiment(const CaseOptions& options) {
  const int devices = options.quick ? 1 : k_devices;
  int done = 0;
  const auto step = [&] {
    if (options.progress) options.progress(++done, 3 * devices);
  };
  return {"verify",
          {agreeing("errors as stated", Drawn::as_stated, devices, options, step),
           agreeing("every error below one sigma", Drawn::below_one_sigma, devices, options, step),
           disagreeing(devices, options, step)},
          {}};
}

}  // namespace glint
