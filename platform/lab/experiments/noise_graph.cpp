#include "platform/lab/experiments/noise_graph.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "nodes/tracker.hpp"
#include "platform/lab/experiments/noisy_frame.hpp"
#include "platform/lab/experiments/point_run.hpp"
#include "platform/runtime/session/accuracy.hpp"
#include "platform/runtime/session/gross.hpp"
#include "platform/runtime/session/pipeline.hpp"
#include "platform/sim/hand_motion.hpp"

namespace glint {
namespace {

constexpr std::uint64_t k_graph_case = 5000;  // of the random numbers
constexpr double k_start_tilt_rad = 0.4;

std::unique_ptr<MarkerTracker> started(const GraphNoiseCase& one, const Camera& camera) {
  Cell cell = default_cell();
  set_camera(cell, camera);
  if (one.oracle) {
    cell.camera.range_sigma_m = one.noise.range_m;
    cell.camera.pixel_sigma_px = one.noise.pixel_px;
  }
  cell.tools.items[0] = one.tool.tool;
  cell.tools.count = 1;
  auto tracker = std::make_unique<MarkerTracker>();
  configure(cell, *tracker);
  tracker->latest<ToolSet>().set(cell.tools, 1, 0);
  tracker->input<HeadPose>().valid = true;
  return tracker;
}

sim::MotionPointer hand_of(const GraphNoiseCase& one, std::uint64_t seed) {
  SampleNumbers numbers(seed, k_graph_case + 1, 0);
  sim::HandSettings hand;
  hand.T_world_tool = draw_pose(one.tool, 0.5, k_start_tilt_rad, numbers).T_camera_tool;
  hand.grip_m = marker_mean(one.tool.tool);
  return sim::hand_motion(hand, seed, 0);
}

bool is_gross_now(const MarkerTracker& tracker, const NoisyFrame& frame, const Tool& tool) {
  const Estimates& estimates = tracker.output<Estimates>();
  const Track& track = estimates.tracks[0];
  const FittedTool& fitted = tracker.parts<FittedTools>(0).tools[0];
  const Labeling& labeling = labeling_of(tracker.token<Assignment>(), fitted, 0);
  TrackingError error;
  error.tip_m = (track.T_camera_tool * tool.tip_m - frame.truth * tool.tip_m).norm();
  error.angle_rad = rotation_between_rad(track.T_camera_tool, frame.truth);
  error.tip_sigma_m =
      std::sqrt(tip_covariance(track, fitted, estimates.tips[0]).topLeftCorner<3, 3>().trace());
  for (std::size_t m = 0; m < labeling.marker.size(); ++m) {
    const bool used = ((fitted.marker_mask >> m) & 1) != 0;
    error.misassigned |= used && labeling.marker[m] != frame.view.truth[m];
  }
  return is_gross(error);
}

}  // namespace

GraphNoiseTally run_noise_graph(const GraphNoiseCase& one, int frames, std::uint64_t seed) {
  const Camera camera = ahat_ray_table();
  const Tool& tool = one.tool.tool;
  const sim::MotionPointer hand = hand_of(one, seed);
  const auto frame = std::make_unique<NoisyFrame>();
  std::unique_ptr<MarkerTracker> tracker = started(one, camera);
  GraphNoiseTally tally;
  for (int i = 0; i < frames; ++i) {
    SampleNumbers numbers(seed, k_graph_case, static_cast<std::uint64_t>(i));
    const NoisyScene scene{one.tool, one.noise, one.strays};
    if (one.start == GraphStart::each_frame) {
      if (i > 0) tracker = started(one, camera);
      draw_frame(scene, camera, numbers, *frame);
    } else {
      draw_frame(scene, camera, hand->pose(frame_time(i)), numbers, *frame);
    }
    const Time time = frame_time(i) + milliseconds(1);
    tracker->input<FrameStamp>() = {
        time, {}, time, static_cast<std::uint64_t>(i) + 1, Reason::none};
    tracker->input<HeadPose>().time = time;
    tracker->input<Markers>() = frame->view.markers;
    tracker->activate();
    const Track& track = tracker->output<Estimates>().tracks[0];
    const auto visible =
        tool.marker_count -
        std::count(frame->view.truth.begin(), frame->view.truth.begin() + tool.marker_count, -1);
    tally.gross += track.measured_now && is_gross_now(*tracker, *frame, tool) ? 1 : 0;
    if (visible < k_trackable_markers) continue;
    ++tally.trackable;
    tally.fresh += track.measured_now ? 1 : 0;
    if (!track.measured_now) ++tally.missed[static_cast<std::size_t>(track.reason)];
  }
  return tally;
}

}  // namespace glint
