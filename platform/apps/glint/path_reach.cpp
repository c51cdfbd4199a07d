#include "platform/apps/glint/path_reach.hpp"

#include <algorithm>
#include <cstdio>
#include <numbers>
#include <set>
#include <utility>

#include "platform/in_range.hpp"
#include "platform/input_error.hpp"
#include "platform/printable.hpp"
#include "platform/tools/programming/robot_program.hpp"
#include "platform/tools/programming/sampled_path.hpp"
#include "platform/tools/reference/find_reference.hpp"
#include "platform/tools/robot/joint_file.hpp"

namespace glint {
namespace {

constexpr std::size_t k_listed_max = 20;  // failures in the table and in a program's header

using FailedPoints = std::set<std::pair<std::size_t, std::size_t>>;  // element, point

PathCheckSettings settings_of(const ReachArguments& arguments, const KinematicChain& chain) {
  PathCheckSettings settings = arguments.settings;
  settings.joint_step_max = arguments.joint_step_deg * std::numbers::pi / 180;
  if (!arguments.start_joints.empty()) {
    settings.start = read_joint_positions(arguments.start_joints, chain.joints);
  }
  if (!arguments.workspace.empty()) {
    settings.workspace_m.emplace();
    std::copy_n(arguments.workspace.begin(), 6, settings.workspace_m->begin());
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if ((*settings.workspace_m)[axis] < (*settings.workspace_m)[axis + 3]) continue;
      throw InputError("--workspace: expected x,y,z of the minimum, then of a larger maximum");
    }
  }
  return settings;
}

std::vector<std::string> listed(const std::vector<std::string>& failures) {
  std::vector<std::string> lines(
      failures.begin(),
      failures.begin() + static_cast<std::ptrdiff_t>(std::min(failures.size(), k_listed_max)));
  if (failures.size() > k_listed_max) {
    lines.push_back("and " + std::to_string(failures.size() - k_listed_max) + " more");
  }
  return lines;
}

void add_collisions(const DrawnPath& path, const FollowedPath& followed,
                    const KinematicChain& chain, const ReachArguments& arguments,
                    const PathCheckSettings& settings, PathReachReport& report,
                    FailedPoints& failed) {
  CollisionSettings collisions = arguments.collisions;
  collisions.T_map_robot = map_pose(arguments);
  const RobotModel robot = load_robot({arguments.robot, arguments.package_dirs});
  const PathMotion motion = path_motion(path, followed, chain, settings, arguments.steps);
  for (const PathCollision& one : check_collisions(motion, robot, chain, collisions)) {
    report.failures.push_back(collision_text(path, one));
    failed.insert({one.element, one.point});
  }
  report.moves_not_followed = motion.not_followed;
  std::printf("collisions: %zu samples of %lld moves\n", motion.samples.size(),
              static_cast<long long>(motion.moves));
  if (motion.not_followed > 0) {
    std::printf(
        "notice  %lld moves not checked between their points: the robot changes its "
        "configuration\n",
        static_cast<long long>(motion.not_followed));
  }
}

std::string not_checked_text(const ReachArguments& arguments, bool collisions,
                             std::int64_t not_followed) {
  if (!collisions) return "NOT CHECKED: motion between points, collisions.";
  std::string text = "NOT CHECKED: the move to the first point";
  if (not_followed > 0)
    text += ", " + std::to_string(not_followed) + " moves without a continuous solution";
  if (arguments.collisions.octomap.empty()) text += ", collisions with a map";
  if (!arguments.collisions.links) text += ", collisions between links";
  for (const std::string& link : arguments.collisions.touching)
    text += ", link " + link + " with the map";
  return text + '.';
}

}  // namespace

void add_reach_options(CLI::App& command, ReachArguments& arguments) {
  CLI::Option* robot = command.add_option(
      "--robot", arguments.robot,
      "URDF file: checks each point for reachability, joint limits and singularities");
  CLI::Option* tip =
      command.add_option("--tip", arguments.tip, "link of --robot at the pen's tip")->needs(robot);
  robot->needs(tip);
  command
      .add_option("--start-joints", arguments.start_joints,
                  "joint positions before the path, rad or m: .npy or text; default: any")
      ->needs(robot);
  command
      .add_option("--workspace", arguments.workspace,
                  "box of allowed points in the robot's frame, m: x,y,z minimum, then maximum")
      ->delimiter(',')
      ->expected(6)
      ->needs(robot);
  command
      .add_option("--singular-min", arguments.settings.singular_value_min,
                  "smallest allowed singular value of the Jacobian, lengths in reaches")
      ->check(in_range(0.0, 1.0))
      ->capture_default_str();
  command
      .add_option("--joint-step", arguments.joint_step_deg,
                  "largest joint step between two points of a stroke, deg")
      ->check(in_range(0.1, 360.0))
      ->capture_default_str();
  CLI::Option* octomap =
      command
          .add_option("--octomap", arguments.collisions.octomap,
                      "map of `glint map --octomap`: checks collisions of the links with it")
          ->needs(robot);
  command
      .add_option("--map-pose", arguments.map_pose,
                  "the robot's frame in the map: x,y,z,roll,pitch,yaw in m and rad; default: 0")
      ->delimiter(',')
      ->expected(6);
  command
      .add_option("--touching", arguments.collisions.touching,
                  "links that may touch the map, separated by commas")
      ->delimiter(',')
      ->needs(octomap);
  command
      .add_flag("--self-collisions", arguments.collisions.links,
                "checks collisions between links that no joint connects")
      ->needs(robot);
  command
      .add_option("--collision-step", arguments.steps.distance_m,
                  "distance between two samples of a move, m")
      ->check(in_range(1e-4, 0.1))
      ->capture_default_str();
  command
      .add_option("--package-dir", arguments.package_dirs,
                  "folder of package:// in the URDF, or NAME=DIR, for meshes")
      ->allow_extra_args(false)
      ->needs(robot);
  command
      .add_flag("--unchecked", arguments.unchecked,
                "write in spite of failed points, which the program's header states; exit code 1")
      ->needs(robot);
}

Pose map_pose(const ReachArguments& arguments) {
  return arguments.map_pose.empty() ? Pose{} : pose_from_xyz_rpy(arguments.map_pose);
}

PathReachReport check_path(const DrawnPath& drawn, const std::optional<SegmentSettings>& shapes,
                           const ReachArguments& arguments) {
  if (arguments.robot.empty()) return {{}, ProgramSettings{}.checks};
  const KinematicChain chain = read_chain(arguments.robot, arguments.tip);
  const PathCheckSettings settings = settings_of(arguments, chain);
  const DrawnPath path = shapes ? sampled_path(drawn, *shapes, arguments.steps) : drawn;
  const FollowedPath followed = follow_path(path, chain, settings);
  PathReachReport report;
  FailedPoints failed;
  for (const ReachFailure& one : followed.failures) {
    report.failures.push_back(failure_text(path, one));
    failed.insert({one.element, one.point});
  }
  const bool collisions = !arguments.collisions.octomap.empty() || arguments.collisions.links;
  if (collisions) add_collisions(path, followed, chain, arguments, settings, report, failed);
  const std::vector<std::string> lines = listed(report.failures);
  for (const std::string& line : lines) std::printf("failed  %s\n", printable(line).c_str());
  const std::string points =
      std::to_string(point_count(path)) + (shapes ? " points of the fitted moves" : " points");
  const std::string robot = "robot " + chain.robot + ", link " + chain.tip;
  const std::string what =
      std::string("reachability, joint limits, singularities") + (collisions ? ", collisions" : "");
  if (report.failures.empty()) {
    std::printf("checked %s: %s\n", points.c_str(), printable(robot).c_str());
    report.header.push_back("CHECKED: " + what + " of " + points + ": " + robot + '.');
  } else {
    const std::string count = std::to_string(failed.size()) + " of " + points;
    if (!arguments.unchecked) {
      throw InputError(arguments.robot + ": " + count +
                       " fail, the first: " + printable(report.failures.front()) +
                       "; expected none, or --unchecked to write all the same");
    }
    report.header.push_back("UNCHECKED: " + count + " fail: " + robot + '.');
    report.header.insert(report.header.end(), lines.begin(), lines.end());
  }
  report.header.push_back(not_checked_text(arguments, collisions, report.moves_not_followed));
  return report;
}

}  // namespace glint
