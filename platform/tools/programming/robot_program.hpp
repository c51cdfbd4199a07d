// Intermediate form of a robot program: linear and circular moves with speed and blend radius. Each
// post-processor formats it in its dialect and adds nothing to the motion.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "platform/tools/programming/path.hpp"
#include "platform/tools/programming/stroke_moves.hpp"

namespace glint {

struct ProgramSettings {
  double travel_m_s = 0.25;  // to waypoints and to the start of strokes
  double stroke_m_s = 0.05;  // along strokes
  double acceleration_m_s2 = 0.5;
  double blend_m = 0.005;  // maximum; also at most half of the distance to either neighbour
  std::string name = "glint_path";
  std::string recording{};  // for the header; empty: not stated
  // Lines of the header that state what was checked.
  std::vector<std::string> checks{
      "NOT CHECKED: reachability, joint limits, singularities, collisions."};
  // The moves are written in this frame, which the program defines or states; empty: in the
  // robot's.
  std::optional<Pose> T_robot_user{};
  // The controller's number of the moves' frame; 0: its base. With T_robot_user only LS has one.
  int user_frame = 0;
  int tool_frame = 1;  // the controller's number of the tip's frame
  // Lines and arcs of strokes become one move each, or two for more than half a circle; empty: a
  // move to each point.
  std::optional<SegmentSettings> shapes{};
};

enum class MoveKind : std::uint8_t { travel, along_stroke };

struct RobotMove {
  Pose pose;  // of the tip in the user frame, unit quaternion
  MoveKind kind = MoveKind::travel;
  std::optional<Pose> via;  // a circular move through it; else a linear one
  double speed_m_s = 0;
  double blend_m = 0;   // whole micrometres; 0: the robot stops
  std::string comment;  // before the move; empty: none
};

struct RobotProgram {
  std::string name;  // a letter, then letters, digits or _
  std::vector<std::string> header;
  std::vector<RobotMove> moves;  // one or more
  double acceleration_m_s2 = 0;
  std::optional<Pose> T_robot_user;  // empty: the moves are in the robot's frame
  int user_frame = 0;
  int tool_frame = 0;
};

// A blend is rounded down and ends at half of the distance to either neighbour: controllers refuse
// or shorten overlapping blends. It is 0 where the robot stops: at the program's end and at both
// ends of a stroke.
// Throws InputError for an empty path, a pose that is not finite, a setting that is not above 0
// (blend and frames: 0 or more), or a name that is no identifier.
[[nodiscard]] RobotProgram robot_program(const DrawnPath& path, const ProgramSettings& settings);

}  // namespace glint
