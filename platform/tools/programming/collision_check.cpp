#include "platform/tools/programming/collision_check.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>
#include <tuple>
#include <utility>

#include "kernels/robot/forward_kinematics.hpp"
#include "platform/input_error.hpp"
#include "platform/tools/robot/limited_process.hpp"

namespace glint {
namespace {

constexpr int k_checker_memory_mb = 4096;
constexpr std::size_t k_answer_bytes_max = std::size_t{1} << 28;
constexpr const char* k_shape_names[] = {"box", "cylinder", "sphere"};

std::string numbers(std::initializer_list<double> list) {
  std::array<char, 32> text{};
  std::string line;
  for (const double number : list) {
    std::snprintf(text.data(), text.size(), " %.9g", number);
    line += text.data();
  }
  return line;
}

std::string numbers(const Pose& pose) {
  const Vector3& t = pose.translation;
  const Quaternion& q = pose.rotation;
  return numbers({t.x(), t.y(), t.z(), q.w(), q.x(), q.y(), q.z()});
}

// What the separate program reads: a file in memory.
class RequestFile {
 public:
  explicit RequestFile(const std::string& text) : file_(::memfd_create("glint_collision", 0)) {
    std::size_t done = 0;
    while (file_ >= 0 && done < text.size()) {
      const ssize_t size = ::write(file_, text.data() + done, text.size() - done);
      if (size <= 0) break;
      done += static_cast<std::size_t>(size);
    }
    if (done < text.size()) throw MissingDevice("collision check: no memory for its request");
  }
  ~RequestFile() {
    if (file_ >= 0) ::close(file_);
  }
  RequestFile(const RequestFile&) = delete;
  RequestFile& operator=(const RequestFile&) = delete;
  [[nodiscard]] std::string name() const {
    return "/proc/" + std::to_string(::getpid()) + "/fd/" + std::to_string(file_);
  }

 private:
  int file_;
};

class CollisionRequest {
 public:
  CollisionRequest(const RobotModel& robot, const KinematicChain& chain,
                   const CollisionSettings& settings)
      : robot_(robot), settings_(settings), has_shape_(robot.links.size()) {
    for (const LinkSurface& surface : robot.surfaces)
      has_shape_[static_cast<std::size_t>(surface.link)] = true;
    for (const std::string& joint : chain.joints) {
      const auto at = std::find(robot.inputs.begin(), robot.inputs.end(), joint);
      inputs_.push_back(static_cast<std::size_t>(at - robot.inputs.begin()));
    }
    find_bodies();
  }

  [[nodiscard]] std::string text(const PathMotion& motion) const {
    std::string text = shapes();
    if (!settings_.octomap.empty()) text += map_tests();
    if (settings_.links) text += link_tests();
    LinkPoses poses;
    std::vector<double> positions(robot_.inputs.size());
    for (const MotionSample& sample : motion.samples) {
      for (std::size_t i = 0; i < inputs_.size(); ++i)
        positions[inputs_[i]] = sample.joints(static_cast<unsigned>(i));
      if (forward_kinematics(robot_.tree, positions, poses) != Reason::none)
        throw InputError("collision check: joint positions that are not finite");
      text += "sample";
      for (std::size_t link = 0; link < has_shape_.size(); ++link) {
        if (has_shape_[link]) text += numbers(poses.T_root_link[link]);
      }
      text += '\n';
    }
    return text;
  }

 private:
  // Links that fixed joints connect are one body. Its neighbour towards the root is the nearest
  // body with a shape.
  void find_bodies() {
    body_.assign(robot_.links.size(), 0);
    std::vector<std::size_t> above(robot_.links.size(), 0);
    std::vector<bool> solid(robot_.links.size(), false);
    for (int i = 0; i < robot_.tree.joint_count; ++i) {
      const TreeJoint& joint = robot_.tree.joints[static_cast<std::size_t>(i)];
      const auto link = static_cast<std::size_t>(i) + 1;
      const std::size_t parent = body_[static_cast<std::size_t>(joint.parent_link)];
      const bool fixed = joint.kind == JointKind::fixed;
      body_[link] = fixed ? parent : link;
      if (!fixed) above[link] = parent;
    }
    for (std::size_t link = 0; link < body_.size(); ++link)
      if (has_shape_[link]) solid[body_[link]] = true;
    neighbour_.assign(body_.size(), 0);
    for (std::size_t link = 0; link < body_.size(); ++link) {
      std::size_t at = above[body_[link]];
      while (at != 0 && !solid[at]) at = above[at];
      neighbour_[link] = at;
    }
  }

  [[nodiscard]] std::string shapes() const {
    std::string text;
    for (std::size_t link = 0; link < has_shape_.size(); ++link) {
      if (has_shape_[link]) text += "link " + std::to_string(link) + '\n';
    }
    for (const LinkSolid& solid : robot_.solids) {
      text += k_shape_names[static_cast<std::size_t>(solid.shape)];
      text += ' ' + std::to_string(solid.link) +
              numbers({solid.size_m.x(), solid.size_m.y(), solid.size_m.z()}) +
              numbers(solid.T_link_solid) + '\n';
    }
    for (const LinkSurface& surface : robot_.surfaces) {
      text += "mesh " + std::to_string(surface.link) + ' ' +
              std::to_string(surface.corners.size()) + ' ' + std::to_string(surface.faces.size());
      for (const Vector3f& corner : surface.corners) {
        const Vector3 c = corner.cast<double>();
        text += numbers({c.x(), c.y(), c.z()});
      }
      for (const Face& face : surface.faces) {
        text += ' ' + std::to_string(face.a) + ' ' + std::to_string(face.b) + ' ' +
                std::to_string(face.c);
      }
      text += '\n';
    }
    return text;
  }

  [[nodiscard]] std::string map_tests() const {
    for (const std::string& name : settings_.touching) {
      if (std::find(robot_.links.begin(), robot_.links.end(), name) == robot_.links.end()) {
        throw InputError("--touching: the robot has no link '" + name +
                         "'; expected links that may touch the map");
      }
    }
    std::string text =
        "map" + numbers(settings_.T_map_robot.inverse()) + ' ' + settings_.octomap + '\n';
    for (std::size_t link = 0; link < has_shape_.size(); ++link) {
      const bool touching = std::find(settings_.touching.begin(), settings_.touching.end(),
                                      robot_.links[link]) != settings_.touching.end();
      if (has_shape_[link] && body_[link] != 0 && !touching)
        text += "test_map " + std::to_string(link) + '\n';
    }
    return text;
  }

  [[nodiscard]] std::string link_tests() const {
    std::string text;
    for (std::size_t a = 0; a < has_shape_.size(); ++a) {
      for (std::size_t b = a + 1; b < has_shape_.size(); ++b) {
        const std::size_t body_a = body_[a], body_b = body_[b];
        const bool adjacent = body_a == body_b || (body_b != 0 && neighbour_[b] == body_a) ||
                              (body_a != 0 && neighbour_[a] == body_b);
        if (has_shape_[a] && has_shape_[b] && !adjacent)
          text += "test " + std::to_string(a) + ' ' + std::to_string(b) + '\n';
      }
    }
    return text;
  }

  const RobotModel& robot_;
  const CollisionSettings& settings_;
  std::vector<bool> has_shape_;
  std::vector<std::size_t> inputs_;            // of the chain's joints
  std::vector<std::size_t> body_, neighbour_;  // of each link
};

// Lines "SAMPLE LINK [OTHER]", then "end", or "error TEXT".
std::string answer_of(const std::string& request, const CollisionSettings& settings) {
  std::error_code failed;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", failed);
  const RequestFile file(request);
  const ProcessOutput output = output_of({(self.parent_path() / "glint_collision_checker").string(),
                                          file.name(), std::to_string(k_checker_memory_mb)},
                                         {k_answer_bytes_max, settings.time_max});
  const std::string name = settings.octomap.empty() ? "collision check" : settings.octomap;
  if (output.end == ProcessEnd::timed_out) {
    throw InputError(name + ": the collision check takes longer than " +
                     std::to_string(settings.time_max.nanoseconds / 1'000'000'000) +
                     " s; expected fewer points or a larger --collision-step");
  }
  if (output.bytes.starts_with("error ")) throw InputError(name + ": " + output.bytes.substr(6));
  if (output.end != ProcessEnd::done || !output.bytes.ends_with("end\n"))
    throw InputError(name + ": the collision library failed; expected an undamaged map");
  return output.bytes;
}

}  // namespace

std::vector<PathCollision> check_collisions(const PathMotion& motion, const RobotModel& robot,
                                            const KinematicChain& chain,
                                            const CollisionSettings& settings) {
  if (settings.octomap.find('\n') != std::string::npos)
    throw InputError("--octomap: a line break in the file's name; expected none");
  std::istringstream answer(
      answer_of(CollisionRequest(robot, chain, settings).text(motion), settings));
  // The samples of a point: the last one is at it.
  std::map<std::tuple<std::size_t, std::size_t, std::string, std::string>, bool> found;
  for (std::string line; std::getline(answer, line) && line != "end";) {
    std::istringstream words(line);
    std::size_t sample = 0, link = 0, other = 0;
    words >> sample >> link;
    const bool links = static_cast<bool>(words >> other);
    const MotionSample& at = motion.samples.at(sample);
    found[{at.element, at.point, robot.links.at(link), links ? robot.links.at(other) : ""}] |=
        at.at_point;
  }
  std::vector<PathCollision> collisions;
  for (const auto& [key, at_point] : found) {
    const auto& [element, point, link, other] = key;
    collisions.push_back({element, point, at_point, link, other});
  }
  return collisions;
}

std::string collision_text(const DrawnPath& path, const PathCollision& collision) {
  return (collision.at_point ? "" : "move to ") +
         point_text(path, collision.element, collision.point) + ": link " + collision.link +
         " touches " + (collision.other.empty() ? "the map" : "link " + collision.other);
}

}  // namespace glint
