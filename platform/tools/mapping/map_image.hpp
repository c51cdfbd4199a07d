// Rendering of a map from one of its cameras, planes in colours.
#pragma once

#include <string>

#include "kernels/cloud/plane_support.hpp"
#include "kernels/pose/camera_model.hpp"

namespace glint {

// Draws the points nearest to the camera. Points on no plane are grey; surfaces darken with their
// angle to the viewing ray. Throws InputError if the file cannot be written.
void write_map_image(const std::string& path, const PointCloud& map, const PlaneSupport& planes,
                     const CameraModel& camera, const Pose& T_world_camera);

}  // namespace glint
