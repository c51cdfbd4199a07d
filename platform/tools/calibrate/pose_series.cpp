#include "platform/tools/calibrate/pose_series.hpp"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "nodes/tracker.hpp"
#include "platform/cells/tool_file.hpp"
#include "platform/formats/trajectory.hpp"
#include "platform/input_error.hpp"
#include "platform/runtime/session/frame_source.hpp"
#include "platform/tools/calibrate/sightings.hpp"
#include "platform/tools/inspect/recorded_frames.hpp"
#include "platform/tools/inspect/replay_points.hpp"

namespace glint {
namespace {

void check(const PoseSource& source) {
  if (!source.recording.empty()) {
    if (source.poses.empty() && source.points.empty() && !source.of_tip) return;
    throw InputError(
        "calibrate: --recording with --poses, --points or --of-tip; expected it alone");
  }
  if (source.poses.empty() == source.points.empty()) {
    throw InputError("calibrate: expected either --poses FILE or --points FILE");
  }
  if (source.tool.empty() && (!source.points.empty() || source.of_tip)) {
    throw InputError("calibrate: " + std::string(source.of_tip ? "--of-tip" : "--points") +
                     " without --tool; expected the tool file of these points");
  }
}

void take_points(const PoseSource& source, PoseSeries& series) {
  const PointsResult found = replay_points(source.points, source.tool);
  series.begin = found.frames.front().time;
  for (const PointPose& pose : found.frames) {
    if (pose.solved) {
      series.poses.push_back({Time{(pose.time - series.begin).nanoseconds}, pose.pose});
    } else {
      ++series.unsolved;
    }
  }
}

// Minimum noise of a marker's range: the spread within one frame does not contain the bias.
constexpr double k_recorded_range_sigma_m = 0.0015;

void take_recording(const PoseSource& source, PoseSeries& series) {
  const BlobSeries blobs = recorded_blobs(source.poses, "", source.tool);
  if (!blobs.failures.empty()) throw InputError(blobs.failures.front());
  series.tool = blobs.tool;
  const ObservationSeries seen = find_tool(blobs, *series.tool, {k_recorded_range_sigma_m});
  if (seen.observations.empty()) {
    throw InputError(source.poses + ": the tool \"" + series.tool->name.data() +
                     "\" is in none of " + std::to_string(seen.frames) +
                     " frames; expected it in view");
  }
  series.begin = seen.observations.front().pose.time;
  for (const ToolObservation& observation : seen.observations) {
    series.poses.push_back(
        {Time{(observation.pose.time - series.begin).nanoseconds}, observation.pose.pose});
  }
  series.unsolved = seen.unsolved;
}

bool is_recording(const std::string& path) {
  return std::filesystem::path(path).extension() == ".mcap";
}

}  // namespace

PoseSeries recorded_poses(RecordedFrames& recorded, std::size_t tool, PoseFrame frame) {
  PoseSeries series;
  series.what = recorded.path;
  series.tool = recorded.cell.tools.items[tool];
  series.scale_sigma = recorded.cell.camera.uncertainty.range_scale;
  std::vector<TimedPose> in_camera, in_world;
  TrackedFrames tracked =
      track_frames(recorded, Search::tracked, [&](const ArrivedFrame& arrived, Tracker& tracker) {
        const Track& track = tracker.output<Estimates>().tracks[tool];
        if (!track.measured_now) return;
        in_camera.push_back({arrived.frame.mid_exposure, track.T_camera_tool});
        if (track.base == ReferenceFrame::world) in_world.push_back(track.newest);
      });
  if (frame == PoseFrame::by_head)
    frame = 2 * in_world.size() >= in_camera.size() ? PoseFrame::world : PoseFrame::camera;
  series.poses = std::move(frame == PoseFrame::world ? in_world : in_camera);
  series.frame = frame == PoseFrame::world ? "world" : "camera";
  if (series.poses.empty()) {
    throw InputError(recorded.path + ": the tool \"" + series.tool->name.data() +
                     "\" was tracked in none of " + std::to_string(tracked.frames) + " frames" +
                     (frame == PoseFrame::world ? " with a head pose" : "") +
                     "; expected it in view: see `glint inspect --recording`");
  }
  series.begin = series.poses.front().time;
  for (TimedPose& pose : series.poses) pose.time = Time{(pose.time - series.begin).nanoseconds};
  series.unsolved = tracked.frames - static_cast<int>(series.poses.size());
  series.failures = std::move(tracked.failures);
  return series;
}

PoseSeries load_pose_series(const PoseSource& source) {
  check(source);
  PoseSeries series;
  if (!source.recording.empty()) {
    RecordedFrames recorded = open_recorded(source.recording, source.cell_file);
    return recorded_poses(recorded, select_tool(recorded.cell, source.tool), source.frame);
  }
  if (is_recording(source.poses)) {
    if (source.of_tip) {
      throw InputError("calibrate: --of-tip with " + source.poses +
                       "; expected a trajectory (a recording holds poses of the tool's frame)");
    }
    series.what = source.poses;
    take_recording(source, series);
    return series;
  }
  if (!source.tool.empty()) series.tool = named_tool(source.tool);
  if (!source.points.empty()) {
    series.what = source.points;
    take_points(source, series);
    return series;
  }
  Trajectory trajectory = load_trajectory(source.poses);
  series.what = source.poses;
  series.begin = trajectory.begin;
  series.poses = std::move(trajectory.samples);
  if (source.of_tip) {
    const Pose T_tip_tool{Quaternion::Identity(), -series.tool->tip_m};
    for (TimedPose& pose : series.poses) pose.pose = pose.pose * T_tip_tool;
  }
  return series;
}

}  // namespace glint
