#include "platform/tools/programming/ur_script.hpp"

#include <array>

#include "kernels/motion/interpolate.hpp"
#include "platform/tools/programming/program_text.hpp"

namespace glint {
namespace {

// The last is the program's own.
constexpr std::string_view k_urscript_words[] = {
    "AND",    "BREAK", "CONTINUE", "DEF",  "ELIF",  "ELSE", "END",      "FALSE",
    "GLOBAL", "HALT",  "IF",       "IN",   "LOCAL", "NOT",  "OR",       "PASS",
    "RETURN", "SEC",   "THREAD",   "TRUE", "WHILE", "XOR",  "PEN_FRAME"};

// Micrometres, microradians: far below a pose's standard deviation.
std::string fixed(double number) { return fixed_text(number, 6); }

std::string pose_text(const Pose& pose, int digits) {
  const Vector3 turn = rotation_vector(pose.rotation);
  std::string text = "p[";
  for (int i = 0; i < 6; ++i) {
    text += (i == 0 ? "" : ", ") + fixed_text(i < 3 ? pose.translation[i] : turn[i - 3], digits);
  }
  return text + ']';
}

}  // namespace

std::string ur_script(const RobotProgram& program) {
  check_name(program.name, {"urscript", 255, k_urscript_words});
  std::string text;
  for (const std::string& line : program.header) text += "# " + line + '\n';
  const bool framed = program.T_robot_user.has_value();
  text += std::string("# The tip in ") + (framed ? "pen_frame, which is in " : "") +
          "the robot's base frame, metres and rotation vectors.\ndef " + program.name + "():\n";
  if (framed) {  // its rotation acts on the whole path: 1 um at 4 m
    text += "  local pen_frame = " + pose_text(*program.T_robot_user, 9) + '\n';
  }
  const auto in_base = [&](const Pose& pose) {
    return framed ? "pose_trans(pen_frame, " + pose_text(pose, 6) + ')' : pose_text(pose, 6);
  };
  for (const RobotMove& move : program.moves) {
    if (!move.comment.empty()) text += "  # " + move.comment + '\n';
    const bool along = move.kind == MoveKind::along_stroke;
    text += std::string("  ") +
            (move.via ? "movec(" + in_base(*move.via) + ", "
             : along  ? "movep("
                      : "movel(") +
            in_base(move.pose) + ", a=" + fixed(program.acceleration_m_s2) +
            ", v=" + fixed(move.speed_m_s) + ", r=" + fixed(move.blend_m) + ")\n";
  }
  return text + "end\n" + program.name + "()\n";
}

}  // namespace glint
