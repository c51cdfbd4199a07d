#include "platform/tools/calibrate/alignment_file.hpp"

#include <cmath>

#include "platform/cells/toml_reader.hpp"
#include "platform/input_error.hpp"

namespace glint {
namespace {

constexpr double k_length_slack = 1e-3;

Pose pose_in(TomlReader& root, const char* name, const std::string& file) {
  const toml::table* table = root.table(name);
  if (table == nullptr) {
    throw InputError(file + ":1: no table [" + name +
                     "]; expected a file of `glint calibrate align`");
  }
  TomlReader reader(*table, file, std::string(name) + ".");
  const auto position = reader.reals("position_mm", 3);
  const auto rotation = reader.reals("rotation_xyzw", 4);
  if (!position || !rotation) {
    throw InputError(file + ":" + std::to_string(table->source().begin.line) + ": " + name +
                     " is not a pose; expected position_mm and rotation_xyzw");
  }
  const Quaternion q((*rotation)[3], (*rotation)[0], (*rotation)[1], (*rotation)[2]);
  if (std::abs(q.norm() - 1) > k_length_slack) {
    throw InputError(file + ":" + std::to_string(reader.line_of("rotation_xyzw")) + ": " + name +
                     ".rotation_xyzw is not of length 1; expected a rotation");
  }
  return {q.normalized(), 1e-3 * Vector3((*position)[0], (*position)[1], (*position)[2])};
}

}  // namespace

Alignment load_alignment(const std::string& file) {
  const toml::table table = parse_toml(read_text(file), file);
  TomlReader root(table, file, "");
  Alignment alignment;
  alignment.T_reference_poses = pose_in(root, "T_reference_poses", file);
  alignment.T_tool_body = pose_in(root, "T_tool_body", file);
  alignment.offset_s = 1e-3 * root.real("offset_ms", 0, -1e15, 1e15);
  return alignment;
}

std::vector<TimedPose> in_poses_frame(std::vector<TimedPose> reference,
                                      const Alignment& alignment) {
  const Pose T_poses_reference = alignment.T_reference_poses.inverse();
  const Pose T_body_tool = alignment.T_tool_body.inverse();
  const Duration offset{static_cast<std::int64_t>(std::llround(1e9 * alignment.offset_s))};
  for (TimedPose& sample : reference) {
    sample.time = sample.time - offset;
    sample.pose = T_poses_reference * sample.pose * T_body_tool;
  }
  return reference;
}

}  // namespace glint
