// FANUC LS. Syntax: FANUC Robotics, SYSTEM R-30iA and R-30iB HandlingTool Setup and Operations
// Manual: sections /PROG, /ATTR, /MN, /POS, /END; numbered lines that end with ';'; remarks '!' of
// at most 32 characters; L P[i] speed FINE or CRn, C P[i] with P[j] speed on a line without number
// (corner region, 0 to 1000 mm); positions with UF, UT, CONFIG. W, P, R turn about the fixed axes
// x, y, z, in this order.
#include <map>

#include "tests/unit/platform/tools/programming/program_reader.hpp"

namespace glint::test {
namespace ls_reader {

// NAME = value, with the value as text. Returns the number of instructions that it declares.
int attributes(Scanner& in) {
  int lines = -1;
  const auto pairs = [&](std::initializer_list<const char*> names, const char* separator) {
    const char* before = "";
    for (const char* name : names) {
      if (*before != 0) {
        in.expect(before);
        in.expect("\n");
      }
      in.expect(name);
      in.expect("=");
      (void)in.whole();
      before = separator;
    }
  };
  while (!in.accept("/MN")) {
    if (in.accept("OWNER")) {
      in.expect("=");
      in.expect("MNEDITOR");
    } else if (in.accept("COMMENT")) {
      for (const char* token : {"=", "\"", "GLINT", "\""}) in.expect(token);
    } else if (in.accept("LINE_COUNT")) {
      in.expect("=");
      lines = in.whole();
    } else if (in.accept("PROTECT")) {
      in.expect("=");
      in.expect("READ_WRITE");
    } else if (in.accept("TCD:")) {
      pairs({"STACK_SIZE", "TASK_PRIORITY", "TIME_SLICE", "BUSY_LAMP_OFF", "ABORT_REQUEST",
             "PAUSE_REQUEST"},
            ",");
    } else if (in.accept("DEFAULT_GROUP")) {
      for (const char* token : {"=", "1", ",", "*", ",", "*", ",", "*", ",", "*"}) in.expect(token);
    } else {
      in.expect("CONTROL_CODE");
      for (const char* token : {"=", "00000000", "00000000"}) in.expect(token);
    }
    in.expect(";");
    in.expect("\n");
  }
  in.expect("\n");
  return lines;
}

struct Position {
  ReadMove move;
  int user_frame = -1, tool_frame = -1;
};

Position position(Scanner& in) {
  Position read;
  for (const char* token : {"{", "\n", "GP1:", "\n", "UF", ":"}) in.expect(token);
  read.user_frame = in.whole();
  for (const char* token : {",", "UT", ":"}) in.expect(token);
  read.tool_frame = in.whole();
  for (const char* token :
       {",", "CONFIG", ":", "'", "N", "U", "T", ",", "0", ",", "0", ",", "0", "'", ",", "\n"}) {
    in.expect(token);
  }
  double value[6] = {};
  constexpr std::string_view k_names[] = {"X", "Y", "Z", "W", "P", "R"};
  for (int i = 0; i < 6; ++i) {
    in.expect(k_names[i]);
    in.expect("=");
    value[i] = in.number();
    in.expect(i < 3 ? "mm" : "deg");
    if (i < 5) in.expect(",");
    if (i == 2) in.expect("\n");
  }
  for (const char* token : {"\n", "}", ";", "\n"}) in.expect(token);
  read.move.position_m = Eigen::Vector3d(value[0], value[1], value[2]) / 1000;
  const Eigen::Matrix3d about_x = turned(0, value[3]);
  const Eigen::Matrix3d then_y = turned(1, value[4]) * about_x;
  read.move.rotation = turned(2, value[5]) * then_y;
  return read;
}

// The pose that the remarks state for UFRAME: X Y Z mm, W P R deg.
std::optional<ReadFrame> stated_frame(const ReadProgram& program) {
  std::string remarks;
  for (const std::string& remark : program.comments) remarks += remark + ' ';
  const std::string mark = "User frame in the robot's base:";
  const auto at = remarks.find(mark);
  if (at == std::string::npos) return {};
  Scanner in(std::string_view(remarks).substr(at + mark.size()), true);
  double value[6] = {};
  constexpr std::string_view k_names[] = {"X", "Y", "Z", "W", "P", "R"};
  for (int i = 0; i < 6; ++i) {
    in.expect(k_names[i]);
    value[i] = in.number();
    if (i == 2) {
      for (const char* token : {"mm", ","}) in.expect(token);
    }
  }
  in.expect("deg");
  return ReadFrame{Eigen::Vector3d(value[0], value[1], value[2]) / 1000,
                   turned(2, value[5]) * turned(1, value[4]) * turned(0, value[3])};
}

struct Instruction {
  int via = 0;  // of a circular move
  int position = 0;
  double speed_m_s = 0, blend_m = 0;
};

Instruction motion(Scanner& in) {
  Instruction read;
  for (const char* token : {"P", "["}) in.expect(token);
  read.position = in.whole();
  in.expect("]");
  const int mm_s = in.whole();
  if (mm_s < 1 || mm_s > 2000) in.fail("1 to 2000 mm/sec");
  read.speed_m_s = mm_s / 1000.0;
  in.expect("mm/sec");
  const std::string end = in.word();
  if (end != "FINE") {
    if (end.rfind("CR", 0) != 0 || end.size() < 3) in.fail("FINE or CRn");
    for (const char c : end.substr(2)) {
      if (c < '0' || c > '9') in.fail("digits after CR");
    }
    read.blend_m = std::stoi(end.substr(2)) / 1000.0;
    if (read.blend_m > 1) in.fail("a corner region of at most 1000 mm");
  }
  return read;
}

}  // namespace ls_reader

ReadProgram read_ls(const std::string& text) {
  Scanner in(text, true);
  ReadProgram program;
  in.expect("/PROG");
  program.name = in.word();
  if (program.name.size() > 36) in.fail("a name of at most 36 characters");
  for (const char* token : {"\n", "/ATTR", "\n"}) in.expect(token);
  const int lines = ls_reader::attributes(in);
  std::vector<ls_reader::Instruction> motions;
  int line = 0;
  while (!in.accept("/POS")) {
    if (in.whole() != ++line) in.fail("line " + std::to_string(line));
    in.expect(":");
    if (in.accept("!")) {
      std::string remark = in.rest();
      if (remark.size() < 2 || remark.substr(remark.size() - 2) != " ;") in.fail("' ;'");
      remark.resize(remark.size() - 2);
      if (remark.size() > 32) in.fail("a remark of at most 32 characters");
      if (remark.find(';') != std::string::npos) in.fail("one ';' a line");
      program.comments.push_back(remark);
    } else {
      if (in.accept("UFRAME_NUM")) {
        in.expect("=");
        program.user_frame = in.whole();
      } else if (in.accept("UTOOL_NUM")) {
        in.expect("=");
        program.tool_frame = in.whole();
      } else {
        int via = 0;
        if (in.accept("C")) {
          for (const char* token : {"P", "["}) in.expect(token);
          via = in.whole();
          for (const char* token : {"]", "\n", ":"}) in.expect(token);
        } else {
          in.expect("L");
        }
        motions.push_back(ls_reader::motion(in));
        motions.back().via = via;
      }
      in.expect(";");
    }
    in.expect("\n");
  }
  program.frame = ls_reader::stated_frame(program);
  if (line != lines) in.fail("LINE_COUNT " + std::to_string(line));
  in.expect("\n");
  std::map<int, ls_reader::Position> positions;
  while (!in.accept("/END")) {
    for (const char* token : {"P", "["}) in.expect(token);
    const int number = in.whole();
    in.expect("]");
    if (!positions.emplace(number, ls_reader::position(in)).second) in.fail("a new position");
  }
  in.expect("\n");
  if (!in.at_end()) in.fail("nothing after /END");
  for (const ls_reader::Instruction& one : motions) {
    const auto at = positions.find(one.position);
    if (at == positions.end()) in.fail("P[" + std::to_string(one.position) + "]");
    if (at->second.user_frame != program.user_frame ||
        at->second.tool_frame != program.tool_frame) {
      in.fail("the position's frames as selected");
    }
    ReadMove move = at->second.move;
    move.speed_m_s = one.speed_m_s;
    move.blend_m = one.blend_m;
    if (one.via != 0) {
      const auto through = positions.find(one.via);
      if (through == positions.end()) in.fail("P[" + std::to_string(one.via) + "]");
      move.circular = true;
      move.via_m = through->second.move.position_m;
    }
    program.moves.push_back(move);
  }
  return program;
}

}  // namespace glint::test
