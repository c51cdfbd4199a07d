// Triangle meshes of a URDF's boxes, cylinders and spheres, about their centre.
#pragma once

#include <vector>

#include "platform/tools/robot/robot_model.hpp"

namespace glint {

// Lengths in metres; a cylinder's axis is z.
[[nodiscard]] std::vector<Triangle> box_surface(const Eigen::Vector3d& size_m);
[[nodiscard]] std::vector<Triangle> cylinder_surface(double radius_m, double length_m);
[[nodiscard]] std::vector<Triangle> sphere_surface(double radius_m);

}  // namespace glint
