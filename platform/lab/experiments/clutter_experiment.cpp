#include "platform/lab/experiments/clutter_experiment.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "kernels/pose/lever_arm.hpp"
#include "nodes/tracker.hpp"
#include "platform/cells/cell.hpp"
#include "platform/cells/tool_notices.hpp"
#include "platform/input_error.hpp"
#include "platform/lab/baseline/baseline_tracker.hpp"
#include "platform/lab/experiments/clutter_scene.hpp"
#include "platform/lab/experiments/clutter_tally.hpp"
#include "platform/lab/experiments/point_view.hpp"
#include "platform/runtime/session/pipeline.hpp"

namespace glint {
namespace {

constexpr int k_clutter_frames = 2000, k_clutter_frames_quick = 60;
constexpr int k_baseline_frames = 300, k_baseline_frames_quick = 10;
constexpr std::array k_false_markers = {0, 20, 50, 100, 200};
constexpr int k_runs_per_blob = 8;  // as for a cell file that states only blobs

struct ClutterCase {
  std::string name;
  ToolSet tools;
  sim::Scenario scenario;
  Bar tracked, wrong;
};

struct SearchTally {
  int blobs_most = 0, steps_most = 0;
  std::int64_t exhausted = 0;  // searches that ran out of steps

  void add(Tracker& tracker, const ToolSet& tools) {
    blobs_most = std::max(blobs_most, tracker.token<Markers>().count);
    for (int t = 0; t < tools.count; ++t) {
      const Labelings& labelings =
          tracker.parts<ToolLabelings>(t % k_tool_partitions).tools[static_cast<std::size_t>(t)];
      exhausted += labelings.reason == Reason::search_full ? 1 : 0;
      steps_most = std::max(steps_most, static_cast<int>(labelings.hypotheses));
    }
  }
};

Cell cell_of(const ClutterCase& c) {
  Cell cell = default_cell();
  set_camera(cell, c.scenario.camera);
  cell.tools = c.tools;
  cell.budget.blobs = k_blobs_max;
  cell.budget.runs_per_band = std::min(k_runs_per_blob * k_blobs_max, k_runs_per_band_max);
  return cell;
}

// Output of the graph: the filter's pose after the frame, in this frame's camera frame. Its
// covariance is moved from the markers' mean to the tip.
FrameOutcome as_followed(const FrameOutcome& fitted, const Estimates& estimates,
                         const ToolSet& tools, const HeadPose& head) {
  FrameOutcome outcome = fitted;
  for (int t = 0; t < tools.count; ++t) {
    const auto i = static_cast<std::size_t>(t);
    const Track& track = estimates.tracks[i];
    if (!outcome.tools[i].seen) continue;
    const Pose T_middle_tool{Quaternion::Identity(), -tools.items[i].middle_m()};
    const Pose T_base_tool = track.motion.pose * T_middle_tool;
    const bool in_world = track.base == ReferenceFrame::world;
    outcome.tools[i].T_camera_tool =
        in_world ? head.T_world_camera.inverse() * T_base_tool : T_base_tool;
    const MotionCovariance& all = track.motion.covariance;
    Matrix6 covariance;
    covariance << all.block<3, 3>(k_position, k_position), all.block<3, 3>(k_position, k_rotation),
        all.block<3, 3>(k_rotation, k_position), all.block<3, 3>(k_rotation, k_rotation);
    const Vector3 arm =
        track.motion.pose.rotation * (tools.items[i].tip_m - tools.items[i].middle_m());
    outcome.tools[i].tip_sigma_m =
        std::sqrt(moved_covariance(covariance, arm).topLeftCorner<3, 3>().trace());
  }
  return outcome;
}

// One baseline tracker per tool.
class BaselineTrackers {
 public:
  explicit BaselineTrackers(const ClutterCase& c) {
    for (int t = 0; t < c.tools.count; ++t)
      trackers_.emplace_back(c.scenario.camera, c.tools.items[static_cast<std::size_t>(t)]);
  }
  [[nodiscard]] FrameOutcome process(const Frame& frame, const HeadPose& head) {
    FrameOutcome outcome;
    for (std::size_t t = 0; t < trackers_.size(); ++t) {
      const BaselineResult found = trackers_[t].process(frame, head);
      // The baseline states no labeling: `swapped` is judged by all markers.
      outcome.tools[t].seen = found.reason == Reason::none;
      outcome.tools[t].reason = found.reason;
      outcome.tools[t].marker_mask = 0xFF;
      outcome.tools[t].T_camera_tool = found.T_camera_tool;
    }
    return outcome;
  }

 private:
  std::vector<BaselineTracker> trackers_;
};

// Glint's case and the baseline's.
std::vector<ExperimentCase> run_case(const ClutterCase& c, bool quick) {
  const Cell cell = cell_of(c);
  const auto tracker = std::make_unique<Tracker>();
  configure(cell, *tracker);
  tracker->latest<ToolSet>().set(c.tools, 1, 0);
  const sim::Simulator simulator(c.scenario);
  BaselineTrackers baseline(c);
  ClutterTally glint(c.tools), fits(c.tools), published(c.tools);
  SearchTally search;
  sim::SimFrame frame;
  const int baseline_frames = quick ? k_baseline_frames_quick : k_baseline_frames;
  for (int i = 0; i < simulator.frame_count(); ++i) {
    simulator.render(i, frame);
    tracker->input<Frame>() = frame.view();
    tracker->input<HeadPose>() = frame.head;
    tracker->activate();
    search.add(*tracker, c.tools);
    const Estimates& estimates = tracker->output<Estimates>();
    const FrameOutcome fitted = outcome_of(estimates, tracker.get());
    fits.add(fitted, frame.truth);
    glint.add(as_followed(fitted, estimates, c.tools, frame.head), frame.truth);
    if (i < baseline_frames) published.add(baseline.process(frame.view(), frame.head), frame.truth);
  }
  std::vector<Figure> figures = glint.figures(c.tracked, c.wrong);
  figures.push_back({"gross_fits", "", static_cast<double>(fits.gross())});
  figures.push_back({"blobs_most", "", static_cast<double>(search.blobs_most)});
  figures.push_back({"named_most", "", static_cast<double>(search.steps_most)});
  figures.push_back({"searches_full", "", static_cast<double>(search.exhausted)});
  return {{c.name, "glint", glint.trackable(), std::move(figures)},
          {c.name, "baseline", published.trackable(), published.figures({}, {})}};
}

// `refused` is 1 if the cell reader refuses the two tools.
ExperimentCase refusal(const std::string& name, const ToolSet& tools, const Bar& bar) {
  double refused = 0;
  try {
    (void)tool_warnings(tools, {"first.toml", "second.toml"}, "cell.toml");
  } catch (const InputError&) {
    refused = 1;
  }
  return {name, "cell reader", 1, {{"refused", "", refused, bar}}};
}

std::vector<ClutterCase> cases_of(const CaseOptions& options) {
  const int frames = options.quick ? k_clutter_frames_quick : k_clutter_frames;
  std::vector<ClutterCase> cases;
  const ToolSet five = five_tools(options.seed);
  for (const int strays : k_false_markers)
    cases.push_back({"5 tools, " + std::to_string(strays) + " strays", five,
                     cluttered_run(five, strays, frames, options.seed), Bar::at_least(99.5),
                     Bar::at_most(0)});
  const ToolSet close = nearly_equal_tools(k_refused_sigmas);
  const ToolSet distinct = nearly_equal_tools(k_distinct_sigmas);
  const auto passing = [&](const std::string& name, const ToolSet& tools, Passing way) {
    cases.push_back(
        {name, tools, passing_run(tools, way, frames, options.seed), Bar::none(), Bar::at_most(0)});
  };
  passing("just accepted, side by side", close, Passing::beside);
  passing("just accepted, one hides the other", close, Passing::occluding);
  passing("distinguished, side by side", distinct, Passing::beside);
  passing("distinguished, one hides the other", distinct, Passing::occluding);
  return cases;
}

}  // namespace

CaseList run_clutter(const CaseOptions& options) {
  CaseList list{"clutter", {}, {}};
  const std::vector<ClutterCase> cases = cases_of(options);
  for (std::size_t k = 0; k < cases.size(); ++k) {
    for (ExperimentCase& one : options.piece([&] { return run_case(cases[k], options.quick); }))
      list.cases.push_back(std::move(one));
    if (options.progress) options.progress(static_cast<int>(k) + 1, static_cast<int>(cases.size()));
  }
  const ToolSet five = five_tools(options.seed);
  ToolSet same;
  same.count = 2;
  same.items[0] = same.items[1] = five.items[0];
  list.cases.push_back(refusal("one tool twice", same, Bar::at_least(1)));
  list.cases.push_back(
      refusal("a flat tool and its mirror image", mirror_twins(five.items[1]), Bar::at_least(1)));
  list.cases.push_back(
      refusal("the pen and its mirror image", mirror_twins(five.items[0]), Bar::none()));
  list.cases.push_back(
      refusal("just accepted", nearly_equal_tools(k_refused_sigmas), Bar::at_most(0)));
  return list;
}

}  // namespace glint
