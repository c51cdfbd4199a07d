#include "platform/tools/programming/krl.hpp"

#include "platform/tools/programming/program_text.hpp"

namespace glint {
namespace {

constexpr std::string_view k_krl_words[] = {
    "AND",      "ANIN",     "ANOUT",   "AXIS",    "B_AND",    "B_EXOR",  "B_NOT",    "B_OR",
    "BOOL",     "BRAKE",    "CCLOSE",  "CHANNEL", "CHAR",     "CIRC",    "CIRC_REL", "CONFIRM",
    "CONST",    "CONTINUE", "COPEN",   "CREAD",   "CWRITE",   "DECL",    "DEF",      "DEFAULT",
    "DEFDAT",   "DEFFCT",   "DELAY",   "DIGIN",   "DISTANCE", "DO",      "E6AXIS",   "E6POS",
    "ELSE",     "END",      "ENDDAT",  "ENDFCT",  "ENDFOR",   "ENDIF",   "ENDLOOP",  "ENDSWITCH",
    "ENDWHILE", "ENUM",     "EXIT",    "EXOR",    "EXT",      "EXTFCT",  "FALSE",    "FOR",
    "FRAME",    "GLOBAL",   "GOTO",    "HALT",    "IF",       "IMPORT",  "INT",      "INTERRUPT",
    "IS",       "LIN",      "LIN_REL", "LOOP",    "MAXIMUM",  "MINIMUM", "NOT",      "OFF",
    "ON",       "OR",       "POS",     "PRIO",    "PTP",      "PTP_REL", "PUBLIC",   "REAL",
    "REPEAT",   "RESUME",   "RETURN",  "SIGNAL",  "STRUC",    "SWITCH",  "THEN",     "TO",
    "TRIGGER",  "TRUE",     "UNTIL",   "WAIT",    "WHEN",     "WHILE",   "WITH"};

// 0.1 um and 0.00001 degrees: a REAL has 7 digits.
std::string aggregate(const Pose& pose, int degree_digits = 5) {
  const EulerAngles angles = euler_angles(pose.rotation);
  const auto mm = [&](int i) { return fixed_text(1e3 * pose.translation[i], 4); };
  const auto degrees = [&](double angle) { return fixed_text(angle, degree_digits); };
  return "{X " + mm(0) + ",Y " + mm(1) + ",Z " + mm(2) + ",A " + degrees(angles.z_deg) + ",B " +
         degrees(angles.y_deg) + ",C " + degrees(angles.x_deg) + '}';
}

std::string frame_text(const char* list, int number) {
  return number == 0 ? "$NULLFRAME" : list + ('[' + std::to_string(number) + ']');
}

}  // namespace

std::string krl(const RobotProgram& program) {
  check_name(program.name, {"krl", 24, k_krl_words});
  check_number(program.user_frame, 0, 32, "krl", "user frame");
  check_number(program.tool_frame, 0, 16, "krl", "tool frame");
  std::string text = "DEF " + program.name + "( )\n";
  for (const std::string& line : program.header) text += "; " + line + '\n';
  text += "; The tip in the base frame below: mm, degrees about the moving axes z, y, x.\n";
  text += "BAS(#INITMOV,0)\n";
  const auto& frame = program.T_robot_user;  // its rotation acts on the whole path
  text += "$BASE=" + (frame ? aggregate(*frame, 7) : frame_text("BASE_DATA", program.user_frame)) +
          '\n';
  text += "$TOOL=" + frame_text("TOOL_DATA", program.tool_frame) + '\n';
  text += "$IPO_MODE=#BASE\n$ORI_TYPE=#VAR\n";
  text += "$ACC.CP=" + fixed_text(program.acceleration_m_s2, 6) + '\n';
  text += "PTP $AXIS_ACT\n";  // ends the block coincidence run, which a program begins with
  double speed_m_s = 0, blend_m = 0;
  for (const RobotMove& move : program.moves) {
    if (!move.comment.empty()) text += "; " + move.comment + '\n';
    if (move.speed_m_s != speed_m_s) {
      speed_m_s = move.speed_m_s;
      text += "$VEL.CP=" + fixed_text(speed_m_s, 6) + '\n';
    }
    if (move.blend_m > 0 && move.blend_m != blend_m) {
      blend_m = move.blend_m;
      text += "$APO.CDIS=" + fixed_text(1e3 * blend_m, 3) + '\n';
    }
    text += (move.via ? "CIRC " + aggregate(*move.via) + ',' : "LIN ") + aggregate(move.pose) +
            (move.blend_m > 0 ? " C_DIS\n" : "\n");
  }
  return text + "END\n";
}

}  // namespace glint
