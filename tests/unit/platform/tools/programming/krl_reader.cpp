// KUKA KRL. Syntax: KUKA System Software 8.3, Operating and Programming Instructions for System
// Integrators: DEF .. END, names of at most 24 characters, comments from ';' to the line's end, one
// statement a line, aggregates {X 1,Y 2,...}, LIN target [C_DIS], CIRC via,target [C_DIS], $VEL.CP
// [m/s], $ACC.CP [m/s^2], $APO.CDIS [mm]. A, B, C turn about the moving axes z, y, x. A LIN
// statement has no S and T.
#include "tests/unit/platform/tools/programming/program_reader.hpp"

namespace glint::test {
namespace krl_reader {

int frame(Scanner& in, std::string_view list) {
  if (in.accept("$NULLFRAME")) return 0;
  in.expect(list);
  in.expect("[");
  const int number = in.whole();
  if (number < 1) in.fail("a frame from 1");
  in.expect("]");
  return number;
}

ReadMove target(Scanner& in) {
  ReadMove move;
  double value[6] = {};
  constexpr std::string_view k_names[] = {"X", "Y", "Z", "A", "B", "C"};
  in.expect("{");
  for (int i = 0; i < 6; ++i) {
    if (i > 0) in.expect(",");
    in.expect(k_names[i]);
    value[i] = in.number();
  }
  in.expect("}");
  move.position_m = Eigen::Vector3d(value[0], value[1], value[2]) / 1000;
  move.rotation = turned(2, value[3]) * turned(1, value[4]) * turned(0, value[5]);
  return move;
}

}  // namespace krl_reader

ReadProgram read_krl(const std::string& text) {
  Scanner in(text, true);
  ReadProgram program;
  in.expect("DEF");
  program.name = in.word();
  if (program.name.size() > 24) in.fail("a name of at most 24 characters");
  in.expect("(");
  in.expect(")");
  in.expect("\n");
  double speed = 0, zone_mm = 0;
  bool started = false;
  while (!in.accept("END")) {
    if (in.accept(";")) {
      program.comments.push_back(in.rest());
    } else if (in.accept("BAS")) {
      for (const char* token : {"(", "#", "INITMOV", ",", "0", ")"}) in.expect(token);
    } else if (in.accept("$BASE")) {
      in.expect("=");
      if (in.next_is("{")) {
        const ReadMove base = krl_reader::target(in);
        program.frame = ReadFrame{base.position_m, base.rotation};
      } else {
        program.user_frame = krl_reader::frame(in, "BASE_DATA");
      }
    } else if (in.accept("$TOOL")) {
      in.expect("=");
      program.tool_frame = krl_reader::frame(in, "TOOL_DATA");
    } else if (in.accept("$IPO_MODE")) {
      for (const char* token : {"=", "#", "BASE"}) in.expect(token);
    } else if (in.accept("$ORI_TYPE")) {
      for (const char* token : {"=", "#", "VAR"}) in.expect(token);
    } else if (in.accept("$ACC.CP")) {
      in.expect("=");
      program.acceleration_m_s2 = in.number();
    } else if (in.accept("$VEL.CP")) {
      in.expect("=");
      speed = in.number();
    } else if (in.accept("$APO.CDIS")) {
      in.expect("=");
      zone_mm = in.number();
    } else if (in.accept("PTP")) {
      in.expect("$AXIS_ACT");
      started = true;
    } else if (const bool circular = in.accept("CIRC"); circular || in.accept("LIN")) {
      if (!started) in.fail("PTP as the first motion");
      ReadMove via;
      if (circular) {
        via = krl_reader::target(in);
        in.expect(",");
      }
      ReadMove move = krl_reader::target(in);
      move.circular = circular;
      if (circular) move.via_m = via.position_m;
      move.speed_m_s = speed;
      move.blend_m = in.accept("C_DIS") ? zone_mm / 1000 : 0;
      program.moves.push_back(move);
    } else {
      in.fail("a statement");
    }
    in.expect("\n");
  }
  in.expect("\n");
  if (!in.at_end()) in.fail("nothing after END");
  return program;
}

}  // namespace glint::test
