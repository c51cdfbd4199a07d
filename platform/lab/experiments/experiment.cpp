#include "platform/lab/experiments/experiment.hpp"

#include <chrono>
#include <opencv2/core/utility.hpp>

#include "platform/cells/tool_file.hpp"
#include "platform/lab/baseline/baseline_tracker.hpp"
#include "platform/lab/experiments/declared.hpp"
#include "platform/lab/experiments/glint_chain.hpp"
#include "platform/lab/experiments/method_record.hpp"
#include "platform/sim/scenarios.hpp"
#include "platform/sim/simulator.hpp"

namespace glint {
namespace {

constexpr int k_bins = 61;  // odd: one bin is centred at zero
constexpr int k_progress_every = 50;
constexpr int k_quick_part = 10;

// Returns the result of process() and its duration in seconds.
template <class Process>
std::pair<Result<UncertainPose>, double> timed(Process&& process) {
  const auto begin = std::chrono::steady_clock::now();
  const Result<UncertainPose> answer = process();
  return {answer, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count()};
}

ExperimentRun make_run(sim::Scenario scenario, int judged, const ExperimentOptions& options) {
  ExperimentRun run;
  scenario.seed += options.seed - 1;
  run.scenario = std::move(scenario);
  const int part = options.quick ? k_quick_part : 1;
  run.aligning = sim::k_aligning_frames / part;
  run.skipped = sim::k_aligning_frames - run.aligning;
  run.judged = judged / part;
  return run;
}

// What all methods did in one run.
struct RunSamples {
  MethodSamples baseline, glint, referenced, perfect;
  std::vector<Vector3> reference_m;  // path of the reference
};

RunSamples run_samples(const ExperimentRun& run, const Tool& tool,
                       const sim::ReferenceSettings& judge,
                       const std::function<void()>& frame_done) {
  const sim::Simulator simulator(run.scenario), reference_simulator(with_reference(run.scenario));
  BaselineTracker baseline_tracker(run.scenario.camera, tool);
  const HeadNoise noise;  // as shipped: the simulated headset differs
  GlintChain free_chain(run.scenario.camera, ChainSetup{{tool}, -1, noise});
  GlintChain referenced_chain(run.scenario.camera, ChainSetup{{tool, reference_body()}, 1, noise});
  MethodRecord baseline(tool, judge), glint(tool, judge), referenced(tool, judge),
      perfect(tool, judge);
  std::vector<Vector3> reference_m;
  sim::SimFrame frame, with_reference_body;
  const int end = std::min(run.skipped + run.aligning + run.judged, simulator.frame_count());
  for (int i = run.skipped; i < end; ++i) {
    simulator.render(i, frame);
    reference_simulator.render(i, with_reference_body);
    const auto baseline_answer = timed([&]() -> Result<UncertainPose> {
      const BaselineResult answer = baseline_tracker.process(frame.view(), frame.head);
      const Pose T_tool_tip{Quaternion::Identity(), tool.tip_m};
      return {{{}, frame.head.T_world_camera * answer.T_camera_tool * T_tool_tip, Matrix6::Zero()},
              answer.reason};
    });
    const auto followed = [](GlintChain& chain, const sim::SimFrame& seen) {
      return timed([&] {
        (void)chain.process(seen.view(), seen.head);
        return chain.followed();
      });
    };
    const auto glint_answer = followed(free_chain, frame);
    const auto referenced_answer = followed(referenced_chain, with_reference_body);
    const bool aligning = i < run.skipped + run.aligning;
    const auto take = aligning ? &MethodRecord::take_aligning : &MethodRecord::add_evaluated;
    (baseline.*take)(frame, baseline_answer.first, baseline_answer.second);
    (glint.*take)(frame, glint_answer.first, glint_answer.second);
    (referenced.*take)(with_reference_body, referenced_answer.first, referenced_answer.second);
    const Pose T_camera_tip = frame.truth.T_world_camera.inverse() *
                              frame.truth.T_world_tool.front() *
                              Pose{Quaternion::Identity(), tool.tip_m};
    (perfect.*take)(frame, {{{}, frame.head.T_world_camera * T_camera_tip, Matrix6::Zero()}}, 0);
    if (!aligning) reference_m.push_back(frame.reference.front() * tool.tip_m);
    frame_done();
  }
  return {baseline.samples(), glint.samples(), referenced.samples(), perfect.samples(),
          reference_m};
}

}  // namespace

sim::Scenario with_reference(sim::Scenario scenario) {
  sim::ToolBody board;
  board.tool = reference_body();
  scenario.tools.push_back(board);
  sim::lay_on_table(scenario, scenario.tools.size() - 1);
  return scenario;
}

ExperimentBars bars_of(ExperimentKind kind) {
  return kind == ExperimentKind::still ? ExperimentBars{0.5, 0.2} : ExperimentBars{1.5, 0.6};
}

int missed_bars(const ExperimentResult& result) {
  const ExperimentBars bars = bars_of(result.kind);
  const MethodFigures& referenced = result.glint_held;
  // Without a sample the mean is zero: no bar is met.
  const bool any = referenced.samples > 0;
  return (any && referenced.position_mm.summary.mean_abs <= bars.position_mm ? 0 : 1) +
         (any && referenced.angle_deg.summary.mean_abs <= bars.angle_deg ? 0 : 1);
}

PublishedFigures published_figures(ExperimentKind kind) {
  PublishedFigures figures;
  if (kind == ExperimentKind::still) {
    figures.position_mean_abs_mm = 1.9;
    figures.angle_mean_abs_deg = 0.37;
    figures.frames_per_s = 46;
    figures.samples = 5000;
  } else {
    figures.position_mean_abs_mm = 22.1;
    figures.angle_mean_abs_deg = 3.87;
    figures.position_sd_mm = 30.7;
    figures.angle_sd_deg = 5.39;
    figures.position_median_mm = -0.1;
    figures.angle_median_deg = 0.22;
    figures.frames_per_s = 41;
    figures.samples = 10000;
  }
  return figures;
}

ErrorColumn make_error_column(std::span<const double> values, std::span<const double> norms) {
  ErrorColumn column;
  column.summary = summarize(values);
  column.norm_mean = summarize(norms).mean;
  column.norm_p95 = percentile(norms, 0.95);
  column.histogram = make_symmetric_histogram(values, k_bins);
  column.fit = fit_gaussian(column.histogram);
  return column;
}

ExperimentResult run_experiment(ExperimentKind kind, const std::vector<ExperimentRun>& runs,
                                const ExperimentOptions& options) {
  cv::setNumThreads(1);  // both methods on one thread
  ExperimentResult result;
  result.kind = kind;
  result.quick = options.quick;
  result.declared = declared_parameters(runs);
  result.config_hash = fnv1a_text(result.declared);
  int total = 0, done = 0;
  for (const ExperimentRun& run : runs) total += run.aligning + run.judged;

  const Tool tool = runs.front().scenario.tools.front().tool;
  const sim::ReferenceSettings& judge = runs.front().scenario.reference;
  const auto frame_done = [&] {
    if (options.progress && (++done % k_progress_every == 0 || done == total))
      options.progress(done, total);
  };
  RunSamples all;
  for (const ExperimentRun& run : runs) {
    const RunSamples one = options.piece([&] { return run_samples(run, tool, judge, frame_done); });
    all.baseline.add_run(one.baseline);
    all.glint.add_run(one.glint);
    all.referenced.add_run(one.referenced);
    all.perfect.add_run(one.perfect);
    all.reference_m = one.reference_m;
  }
  result.baseline = all.baseline.figures("baseline");
  result.glint = all.glint.figures("glint");
  result.glint_held = all.referenced.figures("glint with a reference body");
  result.perfect = all.perfect.figures("a perfect tracker");
  result.path = {all.reference_m, all.baseline.path_m, all.glint.path_m};
  return result;
}

ExperimentResult run_static(const ExperimentOptions& options) {
  return run_experiment(ExperimentKind::still,
                        {make_run(sim::experiment_static(), sim::k_static_frames, options)},
                        options);
}

ExperimentResult run_dynamic(const ExperimentOptions& options) {
  std::vector<ExperimentRun> runs;
  for (int run = 0; run < sim::k_dynamic_runs; ++run)
    runs.push_back(make_run(sim::experiment_dynamic(run), sim::k_dynamic_frames, options));
  return run_experiment(ExperimentKind::moving, runs, options);
}

}  // namespace glint
