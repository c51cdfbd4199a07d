// A robot as its URDF and meshes describe it: joints as a tree, links as triangles.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "kernels/registration/triangle.hpp"
#include "kernels/robot/joint_tree.hpp"

namespace glint {

struct LinkSurface {
  int link = 0;                   // as in LinkPoses
  std::vector<Vector3f> corners;  // in the link's frame
  std::vector<Face> faces;
};

// A whole robot's triangles.
struct PosedSurface {
  std::vector<Vector3f> corners;
  std::vector<Face> faces;
  std::vector<std::uint16_t> face_links{};  // as in LinkPoses; empty: not told apart

  [[nodiscard]] Surface surface() const { return {corners, faces}; }
};

struct RobotModel {
  std::string name;
  JointTree tree;
  std::vector<std::string> links;   // by number; 0 is the root
  std::vector<std::string> inputs;  // the joints that have a value of their own, in URDF order
  std::vector<LinkSurface> surfaces;
  int triangles_skipped = 0;  // without an area, or not finite
};

// What of a link stands for its surface. A link that has none of the kind gets the other.
enum class Geometry { collision, visual };

struct RobotFiles {
  std::string urdf;                       // a file, or where `text` came from
  std::vector<std::string> package_dirs;  // where package:// may lead; "NAME=DIR" for one package
  Geometry geometry = Geometry::collision;
  std::string text{};  // the description itself, in place of a file
};

// Throws InputError, naming file and place: no URDF, a loop or a link with two parents, a joint
// that does not exist or cannot move as it says, a missing or empty mesh, one in millimetres.
[[nodiscard]] RobotModel load_robot(const RobotFiles& files);

// The links' triangles in the root's frame at these positions (radians, metres; one for each of
// robot.inputs). Throws InputError naming `what` where the positions are none.
[[nodiscard]] PosedSurface posed_surface(const RobotModel& robot, std::span<const double> positions,
                                         const std::string& what);

}  // namespace glint
