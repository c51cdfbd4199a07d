// Options of `glint path` that check the path with a robot's kinematics and collisions.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "platform/tools/programming/collision_check.hpp"
#include "platform/tools/programming/reach_check.hpp"
#include "platform/tools/programming/stroke_segments.hpp"

namespace glint {

struct ReachArguments {
  std::string robot, tip, start_joints;
  std::vector<double> workspace;
  double joint_step_deg = 30;
  PathCheckSettings settings;
  CollisionSettings collisions;
  std::vector<double> map_pose;
  std::vector<std::string> package_dirs;
  MotionSteps steps;
  bool unchecked = false;
};

struct PathReachReport {
  std::vector<std::string> failures;    // one line each
  std::vector<std::string> header;      // of the program
  std::int64_t moves_not_followed = 0;  // of the collision check
};

void add_reach_options(CLI::App& command, ReachArguments& arguments);

// The robot's frame in the map.
[[nodiscard]] Pose map_pose(const ReachArguments& arguments);

// With shapes the points of the fitted moves are checked instead of the path's: they are numbered
// along each stroke. Prints the failures. Throws InputError for an invalid robot and, without
// --unchecked, for a failure.
[[nodiscard]] PathReachReport check_path(const DrawnPath& drawn,
                                         const std::optional<SegmentSettings>& shapes,
                                         const ReachArguments& arguments);

}  // namespace glint
