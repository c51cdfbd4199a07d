#include "platform/session/replay_points.hpp"

#include <algorithm>
#include <memory>
#include <optional>

#include "nodes/tracker.hpp"
#include "platform/cells/tool_file.hpp"
#include "platform/sensors/points_csv.hpp"

namespace glint {
namespace {

// Frames are not consecutive to the tracker: every gap is longer than any prior lives.
constexpr Duration k_apart = milliseconds(10'000);

}  // namespace

PointsResult replay_points(const std::string& points_file, const std::string& tool_file) {
  const std::vector<PointFrame> frames = load_points(points_file);
  ToolSet set;
  set.count = 1;
  const std::optional<Tool> built_in = built_in_tool(tool_file);
  set.items[0] = as_points(built_in ? *built_in : load_tool(tool_file));

  auto tracker = std::make_unique<MarkerTracker>();
  tracker->for_each<Correspond>([](Correspond& node) { node.settings = settings_for_points(); });
  tracker->latest<ToolSet>().set(set, 1, 0);

  PointsResult result;
  Time stamp;
  for (const PointFrame& frame : frames) {
    stamp = stamp + k_apart;
    tracker->input<FrameStamp>() = {stamp, stamp, result.frames.size() + 1, Reason::none};
    tracker->input<Markers>() = markers_from_points(frame.points_m);
    tracker->activate();
    const Track& track = tracker->output<Estimates>().tracks[0];
    PointPose pose{frame.time, track.seen_now, track.reason, 0, 0, {}, Vector3::Zero()};
    if (track.seen_now) {
      pose.marker_mask = track.marker_mask;
      pose.rms_m = track.rms_m;
      pose.pose = track.T_camera_tool;
      pose.tip_m = pose.pose * set.items[0].tip_m;
      ++result.solved;
      result.rms_mean_m += pose.rms_m;
      result.rms_max_m = std::max(result.rms_max_m, pose.rms_m);
    }
    result.frames.push_back(pose);
  }
  if (result.solved > 0) result.rms_mean_m /= static_cast<double>(result.solved);
  return result;
}

}  // namespace glint
