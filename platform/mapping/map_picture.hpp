// A map as a picture: seen from one of the cameras that made it, planes in colours.
#pragma once

#include <string>

#include "kernels/cloud/plane_support.hpp"
#include "kernels/pose/camera_model.hpp"

namespace glint {

// Points nearest to the camera are drawn; what is on no plane is grey, and all the darker the more
// the surface turns away. Throws InputError where the file cannot be written.
void write_map_picture(const std::string& path, const PointCloud& map, const PlaneSupport& planes,
                       const CameraModel& camera, const Pose& T_world_camera);

}  // namespace glint
