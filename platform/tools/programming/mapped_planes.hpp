// Planes of a map, as `glint map --json` writes them.
#pragma once

#include <string>
#include <vector>

#include "kernels/geometry.hpp"

namespace glint {

struct MappedPlane {
  Vector3 point = Vector3::Zero(), normal = Vector3::UnitZ();  // in the robot's frame
  double sigma_m = 0;                                          // of its points
};

// T_robot_map: the map's frame. Throws InputError naming file and place for a file without planes
// and for a plane without a normal of length 1, offset_m and rms_mm.
[[nodiscard]] std::vector<MappedPlane> read_mapped_planes(const std::string& file,
                                                          const Pose& T_robot_map);

}  // namespace glint
