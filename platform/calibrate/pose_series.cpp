#include "platform/calibrate/pose_series.hpp"

#include "platform/cells/tool_file.hpp"
#include "platform/input_error.hpp"
#include "platform/session/replay_points.hpp"
#include "platform/sim/trajectory.hpp"

namespace glint {
namespace {

Tool named_tool(const std::string& name) { return name == "pen" ? default_pen() : load_tool(name); }

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

}  // namespace

PoseSeries load_pose_series(const PoseSource& source) {
  check(source);
  PoseSeries series;
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
