#include "platform/lab/experiments/anchored_experiment.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <functional>
#include <string>
#include <utility>

#include "platform/cells/tool_file.hpp"
#include "platform/lab/experiments/experiment.hpp"
#include "platform/lab/experiments/glint_chain.hpp"
#include "platform/lab/experiments/method_record.hpp"
#include "platform/lab/experiments/stated_errors.hpp"
#include "platform/sim/scenarios.hpp"
#include "platform/sim/simulator.hpp"

namespace glint {
namespace {

constexpr std::array<double, 3> k_drifts = {0.3, 1, 3};
constexpr int k_random_seeds = 20;
constexpr int k_aligning = 300, k_judged = 1000;
constexpr int k_aligning_quick = 100, k_judged_quick = 60;
constexpr double k_coverage_min_percent = 90, k_coverage_max_percent = 99;

struct DriftRun {
  ExperimentKind kind;
  double drift;
  std::uint64_t seed;
  int aligning, judged;
};

MethodSamples drift_samples(const DriftRun& run) {
  sim::Scenario scenario =
      run.kind == ExperimentKind::still ? sim::experiment_static() : sim::experiment_dynamic(0);
  scenario.seed += run.seed - 1;
  scale_drift(run.drift, scenario.localisation);
  const Tool tool = scenario.tools.front().tool;
  const sim::Simulator simulator(with_reference(std::move(scenario)));
  GlintChain chain(simulator.scenario().camera, ChainSetup{{tool, reference_body()}, 1, {}});
  MethodRecord record(tool, simulator.scenario().reference);
  sim::SimFrame frame;
  const int begin = sim::k_aligning_frames - run.aligning,
            end = std::min(sim::k_aligning_frames + run.judged, simulator.frame_count());
  for (int i = begin; i < end; ++i) {
    simulator.render(i, frame);
    (void)chain.process(frame.view(), frame.head);
    const auto take =
        i < sim::k_aligning_frames ? &MethodRecord::take_aligning : &MethodRecord::add_evaluated;
    (record.*take)(frame, chain.followed(), 0);
  }
  return record.samples();
}

ExperimentCase judged(ExperimentKind kind, double drift, const CaseOptions& options,
                      const std::function<void()>& step) {
  MethodSamples samples;
  const int seeds = options.quick ? 1 : k_random_seeds;
  for (int i = 0; i < seeds; ++i, step()) {
    samples.add_run(options.piece([&] {
      return drift_samples({kind, drift, options.seed + static_cast<std::uint64_t>(i),
                            options.quick ? k_aligning_quick : k_aligning,
                            options.quick ? k_judged_quick : k_judged});
    }));
  }
  const MethodFigures figures = samples.figures("glint");
  const ExperimentBars bars = bars_of(kind);
  const double covered = 100 * figures.covered.value_or(0);
  const bool still = kind == ExperimentKind::still;
  const auto bar = [&](const Bar& limit) { return options.quick ? Bar::none() : limit; };
  char name[48];
  std::snprintf(name, sizeof name, "%s, drift %.1f", still ? "static" : "dynamic", drift);
  ExperimentCase out{
      name,
      "glint",
      figures.samples,
      {{"position", "mm", figures.position_mm.summary.mean_abs,
        bar(Bar::at_most(bars.position_mm))},
       {"angle", "deg", figures.angle_deg.summary.mean_abs, bar(Bar::at_most(bars.angle_deg))},
       {"inside", "%", covered, bar(Bar::at_least(k_coverage_min_percent))}}};
  if (!still)
    out.figures.push_back({"inside_most", "%", covered, bar(Bar::at_most(k_coverage_max_percent))});
  out.figures.push_back(
      {"frames_measured", "%", 100.0 * figures.samples / std::max(figures.frames, 1)});
  return out;
}

}  // namespace

CaseList run_drift_correction(const CaseOptions& options) {
  CaseList list{"anchored", {}, {}};
  const int all = 2 * static_cast<int>(k_drifts.size()) * (options.quick ? 1 : k_random_seeds);
  int done = 0;
  const auto step = [&] {
    if (options.progress) options.progress(++done, all);
  };
  for (const ExperimentKind kind : {ExperimentKind::still, ExperimentKind::moving})
    for (const double drift : k_drifts) list.cases.push_back(judged(kind, drift, options, step));
  return list;
}

}  // namespace glint
