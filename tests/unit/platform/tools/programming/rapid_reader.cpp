// ABB RAPID. Syntax: ABB, RAPID Kernel (modules, identifiers of at most 32 characters, comments
// from '!' to the line's end) and Technical reference manual, RAPID Instructions, Functions and
// Data types: robtarget [[x,y,z] mm,[q1..q4] = w,x,y,z,confdata,extjoint], speeddata [v_tcp mm/s,
// v_ori, v_leax, v_reax], zonedata [finep,pzone_tcp mm,...], MoveL to, MoveC through,to,
// PathAccLim, ConfL.
#include <array>
#include <map>
#include <numeric>

#include "tests/unit/platform/tools/programming/program_reader.hpp"

namespace glint::test {
namespace rapid_reader {

template <std::size_t n>
std::array<double, n> numbers(Scanner& in) {
  std::array<double, n> values{};
  in.expect("[");
  for (std::size_t i = 0; i < n; ++i) {
    if (i > 0) in.expect(",");
    values[i] = in.number();
  }
  in.expect("]");
  return values;
}

// Rotation of a quaternion w, x, y, z by Rodrigues' formula about its axis.
Eigen::Matrix3d rotation_of(const std::array<double, 4>& q, const Scanner& in) {
  const Eigen::Vector3d v(q[1], q[2], q[3]);
  const double norm = std::sqrt(q[0] * q[0] + v.squaredNorm());
  if (std::abs(norm - 1) > 1e-6) in.fail("a quaternion of norm 1");
  if (v.norm() == 0) return Eigen::Matrix3d::Identity();
  const double angle = 2 * std::atan2(v.norm(), q[0]);
  const Eigen::Vector3d axis = v / v.norm();
  Eigen::Matrix3d k;
  k << 0, -axis[2], axis[1], axis[2], 0, -axis[0], -axis[1], axis[0], 0;
  return Eigen::Matrix3d::Identity() + std::sin(angle) * k + (1 - std::cos(angle)) * (k * k);
}

std::string identifier(Scanner& in) {
  const std::string name = in.word();
  if (name.size() > 32) in.fail("an identifier of at most 32 characters");
  return name;
}

int frame_number(const std::string& name, const std::string& kind, const Scanner& in) {
  if (name.rfind(kind, 0) != 0 || name.size() == kind.size()) in.fail(kind + "N");
  return std::stoi(name.substr(kind.size()));
}

struct Module {
  std::map<std::string, ReadMove> targets;
  std::map<std::string, double> speeds, zones;
  ReadProgram program;
};

// wobjdata: robhold, ufprog, ufmec, uframe, oframe.
void work_object(Scanner& in, ReadProgram& program) {
  for (const char* token :
       {"wobjdata", "pen_frame", ":=", "[", "FALSE", ",", "TRUE", ",", "\"\"", ",", "["})
    in.expect(token);
  const auto position = numbers<3>(in);
  in.expect(",");
  const auto quaternion = numbers<4>(in);
  for (const char* token : {"]", ",", "["}) in.expect(token);
  if (numbers<3>(in) != std::array<double, 3>{}) in.fail("an object frame at the user frame");
  in.expect(",");
  if (numbers<4>(in) != std::array<double, 4>{1}) in.fail("an object frame at the user frame");
  for (const char* token : {"]", "]", ";"}) in.expect(token);
  program.frame = ReadFrame{Eigen::Vector3d(position[0], position[1], position[2]) / 1000,
                            rotation_of(quaternion, in)};
}

void constant(Scanner& in, Module& module) {
  if (in.accept("PERS")) return work_object(in, module.program);
  in.expect("CONST");
  const std::string type = identifier(in), name = identifier(in);
  in.expect(":=");
  bool added = false;
  if (type == "speeddata") {
    added = module.speeds.emplace(name, numbers<4>(in)[0] / 1000).second;
  } else if (type == "zonedata") {
    in.expect("[");
    in.expect("FALSE");
    double value[6] = {};
    for (double& one : value) {
      in.expect(",");
      one = in.number();
    }
    in.expect("]");
    added = module.zones.emplace(name, value[0] / 1000).second;
  } else if (type == "robtarget") {
    ReadMove move;
    in.expect("[");
    const auto position = numbers<3>(in);
    in.expect(",");
    const auto quaternion = numbers<4>(in);
    in.expect(",");
    (void)numbers<4>(in);
    in.expect(",");
    for (const double axis : numbers<6>(in)) {
      if (axis != 9e9) in.fail("9E9 for an axis that is absent");
    }
    in.expect("]");
    move.position_m = Eigen::Vector3d(position[0], position[1], position[2]) / 1000;
    move.rotation = rotation_of(quaternion, in);
    added = module.targets.emplace(name, move).second;
  }
  if (!added) in.fail("a new constant of a known type");
  in.expect(";");
}

template <class Value>
Value found(const std::map<std::string, Value>& values, const std::string& name,
            const Scanner& in) {
  const auto at = values.find(name);
  if (at == values.end()) in.fail("a declared name, not " + name);
  return at->second;
}

void read_move(Scanner& in, bool circular, Module& module) {
  ReadMove via;
  if (circular) {
    via = found(module.targets, identifier(in), in);
    in.expect(",");
  }
  ReadMove move = found(module.targets, identifier(in), in);
  move.circular = circular;
  if (circular) move.via_m = via.position_m;
  in.expect(",");
  move.speed_m_s = found(module.speeds, identifier(in), in);
  in.expect(",");
  if (!in.accept("fine")) move.blend_m = found(module.zones, identifier(in), in);
  in.expect(",");
  module.program.tool_frame = frame_number(identifier(in), "tool", in);
  in.expect("\\");
  in.expect("WObj");
  in.expect(":=");
  const std::string object = identifier(in);
  if (!module.program.frame) {
    module.program.user_frame = frame_number(object, "wobj", in);
  } else if (object != "pen_frame") {
    in.fail("the module's work object");
  }
  in.expect(";");
  module.program.moves.push_back(move);
}

void limit_acceleration(Scanner& in, ReadProgram& program) {
  if (in.accept("FALSE")) {
    for (const char* token : {",", "FALSE", ";"}) in.expect(token);
    return;
  }
  for (const char* token : {"TRUE", "\\", "AccMax", ":="}) in.expect(token);
  program.acceleration_m_s2 = in.number();
  for (const char* token : {",", "TRUE", "\\", "DecelMax", ":="}) in.expect(token);
  if (in.number() != program.acceleration_m_s2) in.fail("the same deceleration");
  in.expect(";");
}

}  // namespace rapid_reader

ReadProgram read_rapid(const std::string& text) {
  Scanner in(text, false);
  rapid_reader::Module module;
  in.expect("MODULE");
  module.program.name = rapid_reader::identifier(in);
  const auto comment = [&] {
    if (!in.accept("!")) return false;
    module.program.comments.push_back(in.rest());
    return true;
  };
  while (!in.accept("PROC")) {
    if (comment()) continue;
    in.expect("LOCAL");
    rapid_reader::constant(in, module);
  }
  if (rapid_reader::identifier(in) == module.program.name) in.fail("a name unlike the module's");
  in.expect("(");
  in.expect(")");
  while (!in.accept("ENDPROC")) {
    if (comment()) continue;
    const bool circular = in.accept("MoveC");
    if (circular || in.accept("MoveL")) {
      rapid_reader::read_move(in, circular, module);
    } else if (in.accept("PathAccLim")) {
      rapid_reader::limit_acceleration(in, module.program);
    } else {
      in.expect("ConfL");
      in.expect("\\");
      if (!in.accept("Off")) in.expect("On");
      in.expect(";");
    }
  }
  in.expect("ENDMODULE");
  if (!in.at_end()) in.fail("nothing after ENDMODULE");
  return module.program;
}

}  // namespace glint::test
