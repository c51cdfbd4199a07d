#include "platform/apps/glint/path_reach.hpp"

#include <algorithm>
#include <cstdio>
#include <numbers>

#include "platform/in_range.hpp"
#include "platform/input_error.hpp"
#include "platform/printable.hpp"
#include "platform/tools/programming/robot_program.hpp"
#include "platform/tools/robot/joint_file.hpp"

namespace glint {
namespace {

constexpr std::size_t k_listed_max = 20;  // failures in the table and in a program's header

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
  command
      .add_flag("--unchecked", arguments.unchecked,
                "write in spite of failed points, which the program's header states; exit code 1")
      ->needs(robot);
}

PathReachReport check_path(const DrawnPath& path, const ReachArguments& arguments) {
  if (arguments.robot.empty()) return {{}, ProgramSettings{}.checks};
  const KinematicChain chain = read_chain(arguments.robot, arguments.tip);
  PathReachReport report;
  for (const ReachFailure& one : check_reach(path, chain, settings_of(arguments, chain))) {
    report.failures.push_back(failure_text(path, one));
  }
  const std::vector<std::string> lines = listed(report.failures);
  for (const std::string& line : lines) std::printf("failed  %s\n", printable(line).c_str());
  const std::string points = std::to_string(point_count(path)) + " points";
  const std::string robot = "robot " + chain.robot + ", link " + chain.tip;
  if (report.failures.empty()) {
    std::printf("checked %s: %s\n", points.c_str(), printable(robot).c_str());
    report.header.push_back("CHECKED: reachability, joint limits, singularities of " + points +
                            ": " + robot + '.');
  } else {
    const std::string count = std::to_string(report.failures.size()) + " of " + points;
    if (!arguments.unchecked) {
      throw InputError(arguments.robot + ": " + count +
                       " fail, the first: " + printable(report.failures.front()) +
                       "; expected none, or --unchecked to write all the same");
    }
    report.header.push_back("UNCHECKED: " + count + " fail: " + robot + '.');
    report.header.insert(report.header.end(), lines.begin(), lines.end());
  }
  report.header.emplace_back("NOT CHECKED: motion between points, collisions.");
  return report;
}

}  // namespace glint
