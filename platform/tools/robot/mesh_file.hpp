// Mesh reader: STL, Collada and OBJ by assimp, in the files' own axes.
//
// Applies a Collada file's unit of length, but not its up axis, like ROS's tools: the URDF rotates
// its meshes itself. STL and OBJ have no unit. Rejects an extent too large or small for a robot's
// link: such a file is in millimetres or was scaled twice.
#pragma once

#include <string>
#include <vector>

#include "kernels/units.hpp"
#include "platform/tools/robot/robot_model.hpp"

namespace glint {

inline constexpr int k_mesh_triangles_max = 2'000'000;

struct Mesh {
  std::vector<Triangle> triangles;
  int skipped = 0;  // triangles without an area, or with a corner that is not finite
};

struct MeshLimits {
  int memory_mb = 1024;  // a mesh of k_mesh_triangles_max needs half of it
  Duration time = milliseconds(30'000);
};

// scale: the URDF's, along x, y, z. assimp reads the file in a separate process, glint_mesh_reader,
// within the limits. Throws InputError naming the file, and MissingDevice if that program is
// missing.
[[nodiscard]] Mesh read_mesh(const std::string& path, const Eigen::Vector3d& scale,
                             const MeshLimits& limits = {});

// Returns the file of a URDF's mesh name: package://NAME/PATH below a package folder, a path
// relative to the URDF, or file://PATH. Security: a description may come from the network. An
// absolute path must be inside a package folder, a relative one there or in the URDF's folder; both
// must be files. Leading parts of a package's path may be missing: the folder may be the package or
// a folder inside it. Throws InputError naming `urdf` and the folders searched.
[[nodiscard]] std::string find_mesh(const std::string& name, const RobotFiles& files);

}  // namespace glint
