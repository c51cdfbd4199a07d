#include "platform/lab/experiments/acquisition_experiment.hpp"

#include <algorithm>
#include <bit>
#include <memory>
#include <string>
#include <utility>

#include "nodes/tracker.hpp"
#include "platform/cells/cell.hpp"
#include "platform/lab/experiments/clutter_scene.hpp"
#include "platform/lab/experiments/point_view.hpp"
#include "platform/lab/experiments/recordings.hpp"
#include "platform/runtime/session/accuracy.hpp"
#include "platform/runtime/session/pipeline.hpp"
#include "platform/sim/simulator.hpp"

namespace glint {
namespace {

constexpr int k_seeds = 20, k_seeds_quick = 3;
constexpr int k_frames = 135, k_frames_quick = 68;  // 3 s, 1.5 s
constexpr double k_found_ms_max = 1000, k_fresh_min = 99;
constexpr int k_findable_markers = 4;  // without a prediction three of many strays agree by chance

// No covariance is asked for: every 20 mm count.
bool far_off(const Tool& tool, const Pose& seen, const Pose& truth) {
  return is_gross(
      {(seen * tool.tip_m - truth * tool.tip_m).norm(), rotation_between_rad(seen, truth)});
}

void add_frame(const Track& track, const Tool& tool, const Pose& truth, int visible, double time_s,
               double& visible_since_s, Acquisition& tally) {
  const bool trackable = visible >= k_trackable_markers, findable = visible >= k_findable_markers;
  if (findable && !tally.visible) visible_since_s = time_s;
  tally.visible = tally.visible || findable;
  if (track.measured_now && !tally.found) {
    tally.found = true;
    tally.found_s = tally.visible ? time_s - visible_since_s : 0;
  }
  if (trackable && !track.measured_now) ++tally.missed[static_cast<std::size_t>(track.reason)];
  if (!tally.found) return;
  tally.trackable += trackable ? 1 : 0;
  tally.fresh += trackable && track.measured_now ? 1 : 0;
  tally.gross += track.measured_now && far_off(tool, track.T_camera_tool, truth) ? 1 : 0;
}

SpotSettings discs(int count, double radius_min_px, double radius_max_px) {
  SpotSettings spots;
  spots.count = count;
  spots.radius_min_px = radius_min_px;
  spots.radius_max_px = radius_max_px;
  return spots;
}

ExperimentCase judged(const AcquisitionCase& one, const CaseOptions& options) {
  const int seeds = options.quick ? k_seeds_quick : k_seeds;
  const int frames = options.quick ? k_frames_quick : k_frames;
  std::int64_t runs = 0, found = 0, gross = 0;
  std::array<std::int64_t, static_cast<std::size_t>(k_last_reason) + 1> missed{};
  double found_ms = 0, fresh = 100;
  for (int i = 0; i < seeds; ++i) {
    const auto seed = options.seed + static_cast<std::uint64_t>(i);
    for (const Acquisition& tool : options.piece([&] { return acquire(one, frames, seed); })) {
      runs += tool.visible ? 1 : 0;
      gross += tool.gross;
      for (std::size_t reason = 0; reason < missed.size(); ++reason)
        missed[reason] += tool.missed[reason];
      if (!tool.visible || !tool.found) continue;
      ++found;
      found_ms = std::max(found_ms, 1000 * tool.found_s);
      if (tool.trackable > 0) {
        fresh = std::min(
            fresh, 100 * static_cast<double>(tool.fresh) / static_cast<double>(tool.trackable));
      }
    }
  }
  const double found_share = 100 * static_cast<double>(found) / static_cast<double>(runs);
  const auto bar = [&](const Bar& limit) { return one.judged ? limit : Bar::none(); };
  std::vector<Figure> figures = {{"found", "%", found_share, bar(Bar::at_least(100))},
                                 {"found_after", "ms", found_ms, bar(Bar::at_most(k_found_ms_max))},
                                 {"fresh", "%", fresh, bar(Bar::at_least(k_fresh_min))},
                                 {"gross", "", static_cast<double>(gross), bar(Bar::at_most(0))}};
  for (std::size_t reason = 0; reason < missed.size(); ++reason) {
    if (missed[reason] == 0) continue;
    figures.push_back({"missed_" + std::string(name_of(static_cast<Reason>(reason))), "",
                       static_cast<double>(missed[reason])});
  }
  return {one.name, "glint", runs, std::move(figures)};
}

}  // namespace

std::vector<AcquisitionCase> acquisition_cases() {
  SpotSettings dim = discs(200, 1, 2.5);
  dim.level_min = 1400;
  dim.level_max = 4000;
  SpotSettings clusters = discs(300, 1.5, 4);
  clusters.clusters = 3;
  SpotSettings moving = discs(200, 2, 5);
  moving.speed_px_s = 200;
  SpotSettings flickering = discs(300, 1.5, 5);
  flickering.flicker_share = 0.5;
  SpotSettings texture = discs(3000, 0, 0);
  texture.clusters = 1;
  texture.cluster_px = 100;
  return {{"200 strays", 1, 200, {}},
          {"1,000 hot pixels", 1, 0, discs(1000, 0, 0)},
          {"2 tools, 200 strays", 2, 200, {}},
          {"2 tools, 1,000 hot pixels", 2, 0, discs(1000, 0, 0)},
          {"200 discs", 1, 0, discs(200, 1.5, 5)},
          {"500 discs", 1, 0, discs(500, 1.5, 5)},
          {"200 large discs", 1, 0, discs(200, 4, 8)},
          {"200 dim discs", 1, 0, dim},
          {"300 discs in 3 clusters", 1, 0, clusters},
          {"200 moving discs", 1, 0, moving},
          {"300 flickering discs", 1, 0, flickering},
          {"4,000 hot pixels", 1, 0, discs(4000, 0, 0), false},
          {"3,000 bright pixels in one place", 1, 0, texture, false}};
}

std::vector<AcquisitionCase> real_frame_cases(const std::string& data) {
  const sim::BackgroundFrame frame = load_hands_and_drill(data);
  return {{"before a real frame, threshold 250", 1, 0, {}, true, 250, frame},
          {"before a real frame, threshold 400", 1, 0, {}, true, 400, frame}};
}

std::vector<Acquisition> acquire(const AcquisitionCase& one, int frames, std::uint64_t seed) {
  ToolSet tools = five_tools(seed);
  tools.count = one.tools;
  sim::Scenario scenario = cluttered_run(tools, one.strays, frames, seed);
  scenario.background = one.background;
  const sim::Simulator simulator(std::move(scenario));
  Cell cell = default_cell();
  set_camera(cell, simulator.scenario().camera);
  if (one.threshold > 0) cell.camera.threshold = static_cast<std::uint16_t>(one.threshold);
  set_camera(cell, cell.camera);
  cell.tools = tools;
  const auto tracker = std::make_unique<Tracker>();
  configure(cell, *tracker);
  tracker->latest<ToolSet>().set(tools, 1, 0);
  const PaintedSpots spots(one.spots, cell.camera, seed);
  std::vector<Acquisition> tallies(static_cast<std::size_t>(tools.count));
  std::vector<double> visible_since_s(tallies.size(), 0);
  sim::SimFrame frame;
  for (int i = 0; i < simulator.frame_count(); ++i) {
    simulator.render(i, frame);
    spots.paint(tools, frame);
    tracker->input<Frame>() = frame.view();
    tracker->input<HeadPose>() = frame.head;
    tracker->activate();
    const Pose T_camera_world = frame.truth.T_world_camera.inverse();
    const double time_s = Duration{frame.truth.mid_exposure.nanoseconds}.seconds();
    for (std::size_t t = 0; t < tallies.size(); ++t) {
      add_frame(tracker->output<Estimates>().tracks[t], tools.items[t],
                T_camera_world * frame.truth.T_world_tool[t],
                std::popcount(frame.truth.visible_mask[t]), time_s, visible_since_s[t], tallies[t]);
    }
  }
  return tallies;
}

CaseList run_acquisition(const CaseOptions& options) {
  CaseList list{"acquire", {}, {}};
  std::vector<AcquisitionCase> cases = acquisition_cases();
  if (!options.data.empty()) {
    for (AcquisitionCase& one : real_frame_cases(options.data)) cases.push_back(std::move(one));
  }
  for (std::size_t k = 0; k < cases.size(); ++k) {
    list.cases.push_back(judged(cases[k], options));
    if (options.progress) options.progress(static_cast<int>(k) + 1, static_cast<int>(cases.size()));
  }
  return list;
}

}  // namespace glint
