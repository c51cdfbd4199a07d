#include "platform/tools/programming/fanuc_ls.hpp"

#include <algorithm>
#include <cmath>

#include "platform/input_error.hpp"
#include "platform/tools/programming/program_text.hpp"

namespace glint {
namespace {

constexpr std::string_view k_fanuc_words[] = {"AUX",  "COM1", "COM2", "COM3", "COM4", "CON",
                                              "LPT1", "LPT2", "LPT3", "NUL",  "PRN"};
constexpr std::size_t k_remark_max = 32;  // characters
constexpr double k_rounding = 1e-6;       // 0.3 m/s is 300 mm/s, not 299

int whole_mm(double metres) { return static_cast<int>(std::floor(1e3 * metres + k_rounding)); }

// Remarks of at most 32 characters, broken at blanks. A semicolon would end the line.
std::vector<std::string> remarks(std::string text) {
  std::replace(text.begin(), text.end(), ';', ',');
  std::vector<std::string> lines;
  while (!text.empty()) {
    std::size_t end = text.size();
    if (end > k_remark_max) {
      end = text.rfind(' ', k_remark_max);
      if (end == std::string::npos || end == 0) end = k_remark_max;
    }
    lines.push_back(text.substr(0, end));
    text.erase(0, std::min(text.find_first_not_of(' ', end), text.size()));
  }
  return lines;
}

std::string corner(double blend_m) {
  return blend_m > 0 ? "CR" + std::to_string(std::max(whole_mm(blend_m), 1)) : "FINE";
}

std::string number_text(const char* name, double number, int digits, const char* unit) {
  return std::string(name) + " = " + fixed_text(number, digits) + ' ' + unit;
}

// Positions in the order of their numbers: a circular move has two.
std::vector<Pose> positions_of(const RobotProgram& program) {
  std::vector<Pose> positions;
  for (const RobotMove& move : program.moves) {
    if (move.via) positions.push_back(*move.via);
    positions.push_back(move.pose);
  }
  return positions;
}

std::string position_text(const RobotProgram& program, const Pose& pose, std::size_t number) {
  const EulerAngles angles = euler_angles(pose.rotation);
  const auto mm = [&](const char* name, int i) {
    return number_text(name, 1e3 * pose.translation[i], 4, "mm");
  };
  return "P[" + std::to_string(number) +
         "]{\n   GP1:\n\tUF : " + std::to_string(program.user_frame) +
         ", UT : " + std::to_string(program.tool_frame) + ",\t\tCONFIG : 'N U T, 0, 0, 0',\n\t" +
         mm("X", 0) + ",\t" + mm("Y", 1) + ",\t" + mm("Z", 2) + ",\n\t" +
         number_text("W", angles.x_deg, 5, "deg") + ",\t" +
         number_text("P", angles.y_deg, 5, "deg") + ",\t" +
         number_text("R", angles.z_deg, 5, "deg") + "\n};\n";
}

// What follows "/MN": each entry is a line without its number and its end.
std::vector<std::string> instructions(const RobotProgram& program) {
  std::vector<std::string> lines;
  const auto remark = [&](const std::string& text) {
    for (const std::string& line : remarks(text)) lines.push_back("  !" + line);
  };
  for (const std::string& line : program.header) remark(line);
  remark(program.T_robot_user ? "Enter the user frame above as UFRAME " +
                                    std::to_string(program.user_frame) + " first."
                              : "The tip in the user frame below.");
  remark("Acceleration: the controller's.");
  lines.push_back("  UFRAME_NUM=" + std::to_string(program.user_frame));
  lines.push_back("  UTOOL_NUM=" + std::to_string(program.tool_frame));
  std::size_t position = 0;
  for (const RobotMove& move : program.moves) {
    remark(move.comment);
    // The second line of a circular move has no number.
    const std::string via =
        move.via ? "C P[" + std::to_string(++position) + "]    \n    :  " : "L ";
    lines.push_back(via + "P[" + std::to_string(++position) + "] " +
                    std::to_string(whole_mm(move.speed_m_s)) + "mm/sec " + corner(move.blend_m));
  }
  return lines;
}

}  // namespace

std::string fanuc_ls(const RobotProgram& program) {
  check_name(program.name, {"ls", 36, k_fanuc_words});
  check_number(program.user_frame, program.T_robot_user ? 1 : 0, 9, "ls", "user frame");
  check_number(program.tool_frame, 1, 10, "ls", "tool frame");
  const std::vector<Pose> positions = positions_of(program);
  if (positions.size() > k_fanuc_positions_max) {
    throw InputError("ls: " + std::to_string(positions.size()) + " positions; expected at most " +
                     std::to_string(k_fanuc_positions_max) +
                     " in one program; set a wider --spacing");
  }
  for (const RobotMove& move : program.moves) {
    check_number(1e3 * move.speed_m_s, 1, 2000, "ls", "speed in mm/s");
    check_number(1e3 * move.blend_m, 0, 1000, "ls", "blend in mm");
  }
  const std::vector<std::string> lines = instructions(program);
  const std::string name = upper_case(program.name);
  std::string text = "/PROG  " + name + "\n/ATTR\nOWNER\t\t= MNEDITOR;\nCOMMENT\t\t= \"GLINT\";\n";
  text += "LINE_COUNT\t= " + std::to_string(lines.size()) + ";\nPROTECT\t\t= READ_WRITE;\n";
  text +=
      "TCD:  STACK_SIZE\t= 0,\n      TASK_PRIORITY\t= 50,\n      TIME_SLICE\t= 0,\n"
      "      BUSY_LAMP_OFF\t= 0,\n      ABORT_REQUEST\t= 0,\n      PAUSE_REQUEST\t= 0;\n"
      "DEFAULT_GROUP\t= 1,*,*,*,*;\nCONTROL_CODE\t= 00000000 00000000;\n/MN\n";
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::string number = std::to_string(i + 1);
    text += std::string(number.size() < 4 ? 4 - number.size() : 0, ' ') + number + ':' + lines[i] +
            " ;\n";
  }
  text += "/POS\n";
  for (std::size_t i = 0; i < positions.size(); ++i)
    text += position_text(program, positions[i], i + 1);
  return text + "/END\n";
}

}  // namespace glint
