// URScript. Syntax: Universal Robots, The URScript Programming Language: def NAME(): .. end,
// comments from '#' to the line's end, movel and movep with a pose, movec with two poses (through,
// to): p[x,y,z,rx,ry,rz] (m, rotation vector), a [m/s^2], v [m/s], r [m]; local NAME = pose;
// pose_trans(from, from_to) is the product of both.
#include "tests/unit/platform/tools/programming/program_reader.hpp"

namespace glint::test {
namespace urscript_reader {

Eigen::Matrix3d rotation_by(const Eigen::Vector3d& turn) {
  const double angle = turn.norm();
  if (angle == 0) return Eigen::Matrix3d::Identity();
  const Eigen::Vector3d axis = turn / angle;
  Eigen::Matrix3d k;
  k << 0, -axis[2], axis[1], axis[2], 0, -axis[0], -axis[1], axis[0], 0;
  return Eigen::Matrix3d::Identity() + std::sin(angle) * k + (1 - std::cos(angle)) * (k * k);
}

double argument(Scanner& in, std::string_view name) {
  in.expect(",");
  in.expect(name);
  in.expect("=");
  return in.number();
}

ReadMove pose(Scanner& in) {
  ReadMove read;
  double value[6] = {};
  for (const char* token : {"p", "["}) in.expect(token);
  for (int i = 0; i < 6; ++i) {
    if (i > 0) in.expect(",");
    value[i] = in.number();
  }
  in.expect("]");
  read.position_m = {value[0], value[1], value[2]};
  read.rotation = rotation_by({value[3], value[4], value[5]});
  return read;
}

ReadMove target(Scanner& in, const ReadProgram& program) {
  if (!program.frame) return pose(in);
  for (const char* token : {"pose_trans", "(", "pen_frame", ","}) in.expect(token);
  const ReadMove read = pose(in);
  in.expect(")");
  return read;
}

ReadMove move(Scanner& in, bool circular, ReadProgram& program) {
  in.expect("(");
  ReadMove via;
  if (circular) {
    via = target(in, program);
    in.expect(",");
  }
  ReadMove read = target(in, program);
  read.circular = circular;
  if (circular) read.via_m = via.position_m;
  program.acceleration_m_s2 = argument(in, "a");
  read.speed_m_s = argument(in, "v");
  read.blend_m = argument(in, "r");
  in.expect(")");
  return read;
}

}  // namespace urscript_reader

ReadProgram read_urscript(const std::string& text) {
  Scanner in(text, true);
  ReadProgram program;
  const auto comment = [&] {
    if (!in.accept("#")) return false;
    program.comments.push_back(in.rest());
    in.expect("\n");
    return true;
  };
  while (comment()) {
  }
  in.expect("def");
  program.name = in.word();
  for (const char* token : {"(", ")", ":", "\n"}) in.expect(token);
  if (in.accept("local")) {
    for (const char* token : {"pen_frame", "="}) in.expect(token);
    const ReadMove frame = urscript_reader::pose(in);
    program.frame = ReadFrame{frame.position_m, frame.rotation};
    in.expect("\n");
  }
  while (!in.accept("end")) {
    if (comment()) continue;
    const bool circular = in.accept("movec"), along = in.accept("movep");
    if (!circular && !along) in.expect("movel");
    program.moves.push_back(urscript_reader::move(in, circular, program));
    program.moves.back().along_stroke = along || circular;
    in.expect("\n");
  }
  in.expect("\n");
  for (const char* token : {program.name.c_str(), "(", ")", "\n"}) in.expect(token);
  if (!in.at_end()) in.fail("nothing after the call");
  return program;
}

}  // namespace glint::test
