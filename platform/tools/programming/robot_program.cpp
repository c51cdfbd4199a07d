#include "platform/tools/programming/robot_program.hpp"

#include <algorithm>
#include <cmath>

#include "platform/input_error.hpp"
#include "platform/printable.hpp"
#include "platform/tools/programming/program_text.hpp"

namespace glint {
namespace {

constexpr double k_step_m = 1e-6;  // of blends, and of positions in every dialect

void check_program(bool right, const std::string& what) {
  if (!right) throw InputError("robot program: " + what);
}

void check(const ProgramSettings& settings) {
  const auto above_0 = [](double number) { return std::isfinite(number) && number > 0; };
  check_program(above_0(settings.travel_m_s), "travel speed; expected a number above 0");
  check_program(above_0(settings.stroke_m_s), "stroke speed; expected a number above 0");
  check_program(above_0(settings.acceleration_m_s2), "acceleration; expected a number above 0");
  check_program(std::isfinite(settings.blend_m) && settings.blend_m >= 0,
                "blend; expected 0 or more");
  check_program(settings.user_frame >= 0 && settings.tool_frame >= 0,
                "number of a frame; expected 0 or more");
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  const auto word = [&](char c) { return letter(c) || (c >= '0' && c <= '9') || c == '_'; };
  check_program(
      !settings.name.empty() && letter(settings.name.front()) &&
          std::all_of(settings.name.begin(), settings.name.end(), word),
      "name \"" + printable(settings.name) + "\"; expected a letter, then letters, digits or _");
}

// Controllers read their own code page: only ASCII is common to all.
std::string ascii(const std::string& untrusted) {
  std::string clean = untrusted;
  std::replace_if(
      clean.begin(), clean.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return clean;
}

// With digits for 1 um at 4 m from its origin.
std::string user_frame_text(const Pose& T_robot_user) {
  const EulerAngles angles = euler_angles(T_robot_user.rotation);
  const auto mm = [&](int axis) { return fixed_text(1e3 * T_robot_user.translation[axis], 4); };
  const auto degrees = [](double angle) { return fixed_text(angle, 7); };
  return "User frame in the robot's base: X " + mm(0) + " Y " + mm(1) + " Z " + mm(2) + " mm, W " +
         degrees(angles.x_deg) + " P " + degrees(angles.y_deg) + " R " + degrees(angles.z_deg) +
         " deg about the fixed axes x, y, z.";
}

std::vector<std::string> header_of(const DrawnPath& path, const ProgramSettings& settings) {
  std::vector<std::string> header{"Drawn with a tracked pen: " + std::to_string(path.size()) +
                                  " elements, " + std::to_string(point_count(path)) + " points."};
  if (!settings.recording.empty()) header.push_back("Recording: " + settings.recording);
  header.insert(header.end(), settings.checks.begin(), settings.checks.end());
  if (settings.T_robot_user) header.push_back(user_frame_text(*settings.T_robot_user));
  header.emplace_back("Set the tool centre point first; test slowly and in simulation.");
  for (std::string& line : header) line = ascii(line);
  return header;
}

std::string comment_of(const PathElement& element, std::size_t number) {
  return std::to_string(number) +
         (element.kind == PathKind::waypoint
              ? ": waypoint"
              : ": stroke of " + std::to_string(element.points.size()) + " points") +
         (element.name.empty() ? "" : ", " + element.name);
}

double distance_between(const RobotMove& a, const RobotMove& b) {
  return (a.pose.translation - b.pose.translation).norm();
}

// Rounded down, so that the rounding of two blends cannot make them overlap. Positions are rounded
// too, by up to 1.5 steps along the path.
double blend_between(const RobotMove& before, const RobotMove& move, const RobotMove& after,
                     double most) {
  const double half = 0.5 * std::min(distance_between(before, move), distance_between(move, after));
  return std::max(0.0, std::floor(std::min(most, half - k_step_m) / k_step_m) * k_step_m);
}

}  // namespace

RobotProgram robot_program(const DrawnPath& path, const ProgramSettings& settings) {
  check(settings);
  check_program(point_count(path) > 0, "no point in the path; expected one or more");
  RobotProgram program{settings.name,
                       header_of(path, settings),
                       {},
                       settings.acceleration_m_s2,
                       settings.T_robot_user,
                       settings.user_frame,
                       settings.tool_frame};
  std::vector<bool> stops;
  std::size_t number = 0;
  for (const PathElement& element : path) {
    const bool stroke = element.kind == PathKind::stroke;
    ++number;
    for (const UncertainPose& point : element.points) {
      check_program(point.pose.translation.allFinite() && point.pose.rotation.coeffs().allFinite(),
                    "element " + std::to_string(number) + ": a pose that is not finite");
    }
    const std::vector<StrokeMove> moves = stroke_moves(element.points, settings.shapes);
    for (const StrokeMove& move : moves) {
      const bool first = &move == &moves.front();
      const bool last = &move == &moves.back();
      const bool along = stroke && !first;
      program.moves.push_back({move.pose, along ? MoveKind::along_stroke : MoveKind::travel,
                               move.via, along ? settings.stroke_m_s : settings.travel_m_s, 0,
                               first ? comment_of(element, number) : ""});
      stops.push_back(stroke && (first || last));
    }
  }
  for (std::size_t i = 1; i + 1 < program.moves.size(); ++i) {
    if (stops[i]) continue;
    program.moves[i].blend_m = blend_between(program.moves[i - 1], program.moves[i],
                                             program.moves[i + 1], settings.blend_m);
  }
  if (!settings.T_robot_user) return program;
  const Pose T_user_robot = settings.T_robot_user->inverse();
  for (RobotMove& move : program.moves) {
    move.pose = T_user_robot * move.pose;
    if (move.via) move.via = T_user_robot * *move.via;
  }
  return program;
}

}  // namespace glint
