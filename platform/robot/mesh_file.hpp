// Meshes: STL, Collada and OBJ by assimp, as their files have them.
//
// A Collada file's unit of length is applied; its up axis is not, as ROS's own tools leave it: a
// URDF turns its meshes itself. STL and OBJ have no unit; what is far too large or small for a
// robot's link is refused, for then the file is in millimetres, or was scaled twice.
#pragma once

#include <string>
#include <vector>

#include "kernels/units.hpp"
#include "platform/robot/robot_model.hpp"

namespace glint {

inline constexpr int k_mesh_triangles_max = 2'000'000;

struct Mesh {
  std::vector<Triangle> triangles;
  int skipped = 0;  // triangles without an area, or with a corner that is not finite
};

struct MeshLimits {
  int memory_mb = 1024;  // a mesh of k_mesh_triangles_max takes half of it
  Duration time = milliseconds(30'000);
};

// scale: the URDF's, along x, y, z. assimp reads the file in a process of its own,
// glint_mesh_reader, within the limits. Throws InputError naming the file, MissingDevice where that
// program is not there.
[[nodiscard]] Mesh read_mesh(const std::string& path, const Eigen::Vector3d& scale,
                             const MeshLimits& limits = {});

// The file that a URDF's mesh stands for: package://NAME/PATH below one of the package folders, a
// path relative to the URDF, file://PATH. A description may come from the network: an absolute path
// must lie in a package folder, a relative one there or in the URDF's folder; both must be files.
// Of a package's path as much as is needed may be left out at its beginning: the folder may be the
// package itself or one inside of it. Throws InputError naming `urdf` and the places that were
// looked at.
[[nodiscard]] std::string find_mesh(const std::string& name, const RobotFiles& files);

}  // namespace glint
