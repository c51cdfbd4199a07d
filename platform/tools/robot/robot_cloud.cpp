#include "platform/tools/robot/robot_cloud.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>

#include "platform/input_error.hpp"
#include "platform/printable.hpp"
#include "platform/sinks/record/growing_file.hpp"
#include "platform/tools/mapping/file_text.hpp"

namespace glint {
namespace {

using Words = std::vector<std::string_view>;

constexpr std::array<const char*, 7> k_properties = {
    "float x", "float y", "float z", "float nx", "float ny", "float nz", "ushort link"};
constexpr std::size_t k_point_bytes = 6 * sizeof(float) + sizeof(std::uint16_t);
constexpr std::array<const char*, 3> k_kinds = {"fixed", "turning", "sliding"};  // as in JointKind

std::string joined(const Words& words, std::size_t from) {
  std::string text;
  for (std::size_t i = from; i < words.size(); ++i) {
    if (i > from) text += ' ';
    text += words[i];
  }
  return text;
}

std::string joint_line(const TreeJoint& joint) {
  const Vector3& a = joint.axis;
  const Vector3& t = joint.T_parent_joint.translation;
  const Quaternion& q = joint.T_parent_joint.rotation;
  std::string line = std::string("comment joint ") + k_kinds[static_cast<std::size_t>(joint.kind)] +
                     " " + std::to_string(joint.parent_link) + " " + std::to_string(joint.input);
  for (const double value : {joint.multiplier, joint.offset, a.x(), a.y(), a.z(), t.x(), t.y(),
                             t.z(), q.x(), q.y(), q.z(), q.w()}) {
    char text[32];
    std::snprintf(text, sizeof text, " %.17g", value);
    line += text;
  }
  return line + "\n";
}

// Parser of the header's comments.
class Reader {
 public:
  explicit Reader(const std::string& path)
      : file_(path, "a robot's cloud of glint reference --export-model") {}

  RobotCloud read() {
    read_header();
    const auto joints = static_cast<std::size_t>(robot_.tree.joint_count);
    if (!ours_) file_.refuse("no \"comment glint robot cloud 1\"", "a robot's cloud of Glint");
    if (properties_ != k_properties.size()) file_.refuse("too few properties", "x to nz, link");
    if (robot_.links.size() != joints + 1) {
      file_.refuse(
          std::to_string(robot_.links.size()) + " links and " + std::to_string(joints) + " joints",
          "a link more than joints");
    }
    if (!(robot_.spacing_m > 0)) file_.refuse("no spacing_m", "metres from point to point");
    for (std::size_t j = 0; j < joints; ++j) {
      if (robot_.tree.joints[j].input >= static_cast<int>(robot_.inputs.size())) {
        file_.refuse("a joint's input " + std::to_string(robot_.tree.joints[j].input),
                     "one of " + std::to_string(robot_.inputs.size()));
      }
    }
    robot_.tree.input_count = static_cast<int>(robot_.inputs.size());
    read_points();
    return std::move(robot_);
  }

 private:
  void read_header() {
    Words words;
    if (!file_.next_line(words) || words.size() != 1 || words[0] != "ply") {
      file_.refuse("no \"ply\"", "a PLY file");
    }
    while (true) {
      if (!file_.next_line(words)) file_.refuse("the file ends", "end_header");
      if (words.empty()) continue;
      if (words[0] == "end_header") return;
      if (words[0] == "comment") {
        read_comment(words);
      } else if (words[0] == "format") {
        if (joined(words, 1) != "binary_little_endian 1.0") {
          file_.refuse("format " + joined(words, 1), "binary_little_endian 1.0");
        }
      } else if (words[0] == "element" && words.size() == 3 && words[1] == "vertex") {
        count_ = file_.count(words[2], k_model_points_max);
      } else if (words[0] == "property" && properties_ < k_properties.size() &&
                 joined(words, 1) == k_properties[properties_]) {
        ++properties_;
      } else {
        file_.refuse('"' + joined(words, 0).substr(0, 60) + '"',
                     "vertices of float x, y, z, nx, ny, nz and ushort link");
      }
    }
  }

  void read_comment(const Words& words) {
    const std::string_view what = words.size() > 1 ? words[1] : "";
    if (joined(words, 1) == "glint robot cloud 1") ours_ = true;
    if (what == "robot") robot_.name = joined(words, 2);
    if (what == "spacing_m" && words.size() == 3) {
      robot_.spacing_m = static_cast<float>(number(words[2], 1e3));
    }
    if (what == "input" && robot_.inputs.size() < k_robot_joints_max) {
      robot_.inputs.push_back(joined(words, 2));
    }
    if (what == "link" && robot_.links.size() < k_robot_links_max) {
      robot_.links.push_back(joined(words, 2));
    }
    if (what == "joint") read_joint(words);
  }

  double number(std::string_view word, double most) const {
    const double value = file_.number(word);
    if (!(std::abs(value) <= most)) file_.refuse("a number out of range", "metres, radians");
    return value;
  }

  void read_joint(const Words& words) {
    if (words.size() != 17) file_.refuse("a joint of other words", "a kind and 14 numbers");
    if (robot_.tree.joint_count >= k_robot_joints_max) {
      file_.refuse("more joints", "at most " + std::to_string(k_robot_joints_max));
    }
    TreeJoint& joint = robot_.tree.joints[static_cast<std::size_t>(robot_.tree.joint_count)];
    std::size_t kind = 0;
    while (kind < k_kinds.size() && words[2] != k_kinds[kind]) ++kind;
    if (kind == k_kinds.size()) file_.refuse("another kind of joint", "fixed, turning or sliding");
    joint.kind = static_cast<JointKind>(kind);
    joint.parent_link =
        static_cast<int>(file_.count(words[3], static_cast<std::size_t>(robot_.tree.joint_count)));
    joint.input =
        words[4] == "-1" ? -1 : static_cast<int>(file_.count(words[4], k_robot_joints_max - 1));
    std::array<double, 12> v{};
    for (std::size_t i = 0; i < v.size(); ++i) v[i] = number(words[5 + i], 1e6);
    joint.multiplier = v[0];
    joint.offset = v[1];
    joint.axis = {v[2], v[3], v[4]};
    joint.T_parent_joint = {Quaternion(v[11], v[8], v[9], v[10]), {v[5], v[6], v[7]}};
    if (std::abs(joint.axis.norm() - 1) > 1e-6 ||
        std::abs(joint.T_parent_joint.rotation.norm() - 1) > 1e-6) {
      file_.refuse("an axis or a quaternion of a length other than 1", "length 1");
    }
    if (joint.kind != JointKind::fixed && joint.input < 0) {
      file_.refuse("a joint that nothing moves", "the number of its input");
    }
    ++robot_.tree.joint_count;
  }

  void read_points() {
    const std::string_view bytes = file_.rest();
    if (count_ == 0 || bytes.size() != count_ * k_point_bytes) {
      file_.refuse(
          std::to_string(bytes.size()) + " bytes for " + std::to_string(count_) + " points",
          std::to_string(k_point_bytes) + " for each, at least one point");
    }
    for (std::size_t i = 0; i < count_; ++i) {
      std::array<float, 6> v{};
      std::uint16_t link = 0;
      std::memcpy(v.data(), bytes.data() + i * k_point_bytes, sizeof v);
      std::memcpy(&link, bytes.data() + i * k_point_bytes + sizeof v, sizeof link);
      const Vector3f point(v[0], v[1], v[2]), normal(v[3], v[4], v[5]);
      if (!(point.norm() < 1e3f) || !(std::abs(normal.norm() - 1) < 1e-3f) ||
          link >= robot_.links.size()) {
        file_.refuse("point " + std::to_string(i) + " is invalid",
                     "metres, a normal of length 1 and a link's number");
      }
      robot_.points.push_back(point);
      robot_.normals.push_back(normal);
      robot_.point_links.push_back(link);
    }
  }

  FileText file_;
  RobotCloud robot_;
  std::size_t count_ = 0, properties_ = 0;
  bool ours_ = false;
};

}  // namespace

LinkPoses link_poses(const RobotCloud& robot, std::span<const double> positions,
                     const std::string& what) {
  LinkPoses poses;
  if (forward_kinematics(robot.tree, positions, poses) != Reason::none) {
    throw InputError(what + ": " + std::to_string(positions.size()) + " positions; expected " +
                     std::to_string(robot.inputs.size()) + ", finite");
  }
  return poses;
}

PosedCloud posed_cloud(const RobotCloud& robot, std::span<const double> positions,
                       const std::string& what) {
  const LinkPoses poses = link_poses(robot, positions, what);
  PosedCloud out;
  out.points.resize(robot.points.size());
  out.normals.resize(robot.points.size());
  out.spacing_m = robot.spacing_m;
  out.point_links = robot.point_links;
  if (pose_cloud(robot.cloud(), poses, out.points, out.normals) != Reason::none) {
    throw InputError(what + ": the robot's points are of links that it does not have");
  }
  return out;
}

void write_robot_cloud(const std::string& path, const RobotCloud& robot) {
  std::string bytes =
      "ply\nformat binary_little_endian 1.0\ncomment glint robot cloud 1\n"
      "comment robot " +
      printable(robot.name) + "\n";
  char spacing[64];
  std::snprintf(spacing, sizeof spacing, "comment spacing_m %.9g\n",
                static_cast<double>(robot.spacing_m));
  bytes += spacing;
  for (const std::string& input : robot.inputs) bytes += "comment input " + printable(input) + "\n";
  for (std::size_t l = 0; l < robot.links.size(); ++l) {
    if (l > 0) bytes += joint_line(robot.tree.joints[l - 1]);
    bytes += "comment link " + printable(robot.links[l]) + "\n";
  }
  bytes += "element vertex " + std::to_string(robot.points.size()) + "\n";
  for (const char* property : k_properties) bytes += std::string("property ") + property + "\n";
  bytes += "end_header\n";
  for (std::size_t i = 0; i < robot.points.size(); ++i) {
    const Vector3f &p = robot.points[i], &n = robot.normals[i];
    const std::array<float, 6> values = {p.x(), p.y(), p.z(), n.x(), n.y(), n.z()};
    bytes.append(reinterpret_cast<const char*>(values.data()), sizeof values);
    bytes.append(reinterpret_cast<const char*>(&robot.point_links[i]), sizeof(std::uint16_t));
  }
  GrowingFile file(path);
  const auto* const data = reinterpret_cast<const std::uint8_t*>(bytes.data());
  if (!file.append({std::span(data, bytes.size())}) || !file.finish()) {
    throw InputError(path + ": " + file.error() + "; expected a writable path");
  }
}

RobotCloud read_robot_cloud(const std::string& path) { return Reader(path).read(); }

}  // namespace glint
