#include "platform/calibrate/pose_series.hpp"

#include <filesystem>

#include "platform/calibrate/sightings.hpp"
#include "platform/cells/tool_file.hpp"
#include "platform/input_error.hpp"
#include "platform/session/replay_points.hpp"
#include "platform/sim/trajectory.hpp"

namespace glint {
namespace {

Tool named_tool(const std::string& name) {
  const std::optional<Tool> built_in = built_in_tool(name);
  return built_in ? *built_in : load_tool(name);
}

void check(const PoseSource& source) {
  if (source.poses.empty() == source.points.empty()) {
    throw InputError("calibrate: expected either --poses FILE or --points FILE");
  }
  if (source.tool.empty() && (!source.points.empty() || source.of_tip)) {
    throw InputError("calibrate: " + std::string(source.of_tip ? "--of-tip" : "--points") +
                     " without --tool; expected the tool file that goes with it");
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

// What a marker's own range noise is at least: its spread within one frame tells no bias.
constexpr double k_recorded_range_sigma_m = 0.0015;

void take_recording(const PoseSource& source, PoseSeries& series) {
  const BlobSeries blobs = load_blobs(source.poses, "");
  series.tool = tool_of(blobs, source.tool);
  const SightingSeries seen = find_tool(blobs, *series.tool, {k_recorded_range_sigma_m});
  if (seen.sightings.empty()) {
    throw InputError(source.poses + ": the tool \"" + series.tool->name.data() + "\" in none of " +
                     std::to_string(seen.frames) + " frames; expected it in view");
  }
  series.begin = seen.sightings.front().pose.time;
  for (const Sighting& sighting : seen.sightings) {
    series.poses.push_back(
        {Time{(sighting.pose.time - series.begin).nanoseconds}, sighting.pose.pose});
  }
  series.unsolved = seen.unsolved;
}

bool is_recording(const std::string& path) {
  return std::filesystem::path(path).extension() == ".mcap";
}

}  // namespace

PoseSeries load_pose_series(const PoseSource& source) {
  check(source);
  PoseSeries series;
  if (is_recording(source.poses)) {
    if (source.of_tip) {
      throw InputError("calibrate: --of-tip with " + source.poses +
                       "; expected it with a trajectory, a recording gives the tool's own frame");
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
  sim::Trajectory trajectory = sim::load_trajectory(source.poses);
  series.what = source.poses;
  series.begin = trajectory.begin;
  series.poses = std::move(trajectory.samples);
  if (source.of_tip) {
    const Pose T_tip_tool{Quaternion::Identity(), -series.tool->tip_m};
    for (StampedPose& pose : series.poses) pose.pose = pose.pose * T_tip_tool;
  }
  return series;
}

}  // namespace glint
