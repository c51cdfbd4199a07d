#include "platform/tools/programming/rapid.hpp"

#include <algorithm>

#include "platform/tools/programming/program_text.hpp"

namespace glint {
namespace {

// The last is the module's own.
constexpr std::string_view k_rapid_words[] = {
    "ALIAS",     "AND",      "BACKWARD",  "CASE",    "CONNECT",  "CONST",    "DEFAULT",
    "DIV",       "DO",       "ELSE",      "ELSEIF",  "ENDFOR",   "ENDFUNC",  "ENDIF",
    "ENDMODULE", "ENDPROC",  "ENDRECORD", "ENDTEST", "ENDTRAP",  "ENDWHILE", "ERROR",
    "EXIT",      "FALSE",    "FOR",       "FROM",    "FUNC",     "GOTO",     "IF",
    "INOUT",     "LOCAL",    "MOD",       "MODULE",  "NOSTEPIN", "NOT",      "NOVIEW",
    "OR",        "PERS",     "PROC",      "RAISE",   "READONLY", "RECORD",   "RETRY",
    "RETURN",    "STEP",     "SYSMODULE", "TEST",    "THEN",     "TO",       "TRAP",
    "TRUE",      "TRYNEXT",  "UNDO",      "VAR",     "VIEWONLY", "WHILE",    "WITH",
    "XOR",       "PEN_FRAME"};
constexpr double k_acceleration_min_m_s2 = 0.1;  // PathAccLim

std::string millimetres(double metres, int digits) { return fixed_text(1e3 * metres, digits); }

std::string pose_data(const Pose& pose) {
  const Vector3& t = pose.translation;
  const Quaternion& q = pose.rotation;
  const auto part = [](double number) { return fixed_text(number, 8); };
  return '[' + millimetres(t.x(), 4) + ',' + millimetres(t.y(), 4) + ',' + millimetres(t.z(), 4) +
         "],[" + part(q.w()) + ',' + part(q.x()) + ',' + part(q.y()) + ',' + part(q.z()) + ']';
}

// The last two parts, configuration and external axes, are unknown and unused.
std::string target(const Pose& pose) {
  return '[' + pose_data(pose) + ",[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]";
}

// Fixed in the room, not moved by another unit; the object's frame is the user frame.
std::string work_object(const Pose& T_robot_user) {
  return "[FALSE,TRUE,\"\",[" + pose_data(T_robot_user) + "],[[0,0,0],[1,0,0,0]]]";
}

// Rotation in deg/s and external axes as in the controller's predefined speeds.
std::string speed_data(double m_s) { return '[' + millimetres(m_s, 3) + ",500,5000,1000]"; }

// The zone of the orientation is that of the position; in degrees a tenth of the millimetres, as in
// the controller's predefined zones.
std::string zone_data(double blend_m) {
  const std::string mm = millimetres(blend_m, 3);
  const std::string tenth = millimetres(0.1 * blend_m, 4);
  return "[FALSE," + mm + ',' + mm + ',' + mm + ',' + tenth + ',' + mm + ',' + tenth + ']';
}

// Distinct values in the order of their first use; number_of() counts from 1.
struct Values {
  std::vector<double> sorted;

  void add(double value) {
    const auto at = std::lower_bound(sorted.begin(), sorted.end(), value);
    if (at == sorted.end() || *at != value) sorted.insert(at, value);
  }
  [[nodiscard]] std::string number_of(double value) const {
    const auto at = std::lower_bound(sorted.begin(), sorted.end(), value);
    return std::to_string(at - sorted.begin() + 1);
  }
};

}  // namespace

std::string rapid(const RobotProgram& program) {
  check_name(program.name, {"rapid", 28, k_rapid_words});
  check_number(program.acceleration_m_s2, k_acceleration_min_m_s2, 1e3, "rapid", "acceleration");
  Values speeds, zones;
  for (const RobotMove& move : program.moves) {
    speeds.add(move.speed_m_s);
    if (move.blend_m > 0) zones.add(move.blend_m);
  }
  std::string text = "MODULE " + program.name + '\n';
  for (const std::string& line : program.header) text += "  ! " + line + '\n';
  text += "  ! The tip in the work object below: mm, quaternions w, x, y, z.\n";
  const auto constant = [&](const char* type, const std::string& name, const std::string& value) {
    text += std::string("  LOCAL CONST ") + type + ' ' + name + ":=" + value + ";\n";
  };
  if (program.T_robot_user) {
    text += "  LOCAL PERS wobjdata pen_frame:=" + work_object(*program.T_robot_user) + ";\n";
  }
  for (const double m_s : speeds.sorted) {
    constant("speeddata", "speed" + speeds.number_of(m_s), speed_data(m_s));
  }
  for (const double blend_m : zones.sorted) {
    constant("zonedata", "zone" + zones.number_of(blend_m), zone_data(blend_m));
  }
  for (std::size_t i = 0; i < program.moves.size(); ++i) {
    const RobotMove& move = program.moves[i];
    if (move.via) constant("robtarget", "via" + std::to_string(i + 1), target(*move.via));
    constant("robtarget", "target" + std::to_string(i + 1), target(move.pose));
  }
  const std::string limit = fixed_text(program.acceleration_m_s2, 6);
  text += "  PROC run_" + program.name +
          "()\n    ConfL \\Off;\n    PathAccLim TRUE\\AccMax:=" + limit +
          ",TRUE\\DecelMax:=" + limit + ";\n";
  const std::string frames =
      ",tool" + std::to_string(program.tool_frame) + "\\WObj:=" +
      (program.T_robot_user ? "pen_frame" : "wobj" + std::to_string(program.user_frame)) + ";\n";
  for (std::size_t i = 0; i < program.moves.size(); ++i) {
    const RobotMove& move = program.moves[i];
    if (!move.comment.empty()) text += "    ! " + move.comment + '\n';
    text += (move.via ? "    MoveC via" + std::to_string(i + 1) + ',' : "    MoveL ") + "target" +
            std::to_string(i + 1) + ",speed" + speeds.number_of(move.speed_m_s) + ',' +
            (move.blend_m > 0 ? "zone" + zones.number_of(move.blend_m) : "fine") + frames;
  }
  return text + "    PathAccLim FALSE,FALSE;\n    ConfL \\On;\n  ENDPROC\nENDMODULE\n";
}

}  // namespace glint
