// Robot model from URDF and meshes: joints as a tree, links as triangles.
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

enum class SolidShape : std::uint8_t { box, cylinder, sphere };

// Box, cylinder or sphere of a link. Its triangles are in the link's surface, too.
struct LinkSolid {
  int link = 0;  // as in LinkPoses
  SolidShape shape = SolidShape::box;
  Vector3 size_m = Vector3::Zero();  // sides; radius and length, along z; radius
  Pose T_link_solid;
};

// Triangles of the complete robot.
struct PosedSurface {
  std::vector<Vector3f> corners;
  std::vector<Face> faces;
  std::vector<std::uint16_t> face_links{};  // as in LinkPoses; empty: unknown

  [[nodiscard]] Surface surface() const { return {corners, faces}; }
};

struct RobotModel {
  std::string name;
  JointTree tree;
  std::vector<std::string> links;   // by index; 0 is the root
  std::vector<std::string> inputs;  // joints with a value of their own, in URDF order
  std::vector<LinkSurface> surfaces;
  std::vector<LinkSolid> solids;
  int triangles_skipped = 0;  // zero area, or not finite
};

// Geometry used as a link's surface. A link without any of this kind uses the other.
enum class Geometry { collision, visual };

struct RobotFiles {
  std::string urdf;                       // file name, or the origin of `text`
  std::vector<std::string> package_dirs;  // folders for package://; "NAME=DIR" for one package
  Geometry geometry = Geometry::collision;
  std::string text{};  // the description itself, instead of a file
};

// Throws InputError, naming file and place, for no URDF, a loop or a link with two parents, an
// unknown joint or an invalid joint motion, a missing or empty mesh, and a mesh in millimetres.
[[nodiscard]] RobotModel load_robot(const RobotFiles& files);

// Returns the links' triangles in the root's frame at these positions (radians, metres; one for
// each of robot.inputs). Throws InputError naming `what` if the positions are invalid.
[[nodiscard]] PosedSurface posed_surface(const RobotModel& robot, std::span<const double> positions,
                                         const std::string& what);

}  // namespace glint
