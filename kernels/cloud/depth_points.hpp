// A depth picture as points of the world.
//
// What:     each pixel's ray, from the lens, to the depth that stands there, moved by the camera's
//           pose. Every stride-th pixel of every stride-th row, row by row.
// Cost:     one unproject() a pixel taken (camera_model.hpp).
// Worst:    pixels without a depth between the limits, or without a ray, are left out; a full cloud
//           keeps the first ones.
// Accuracy: in double, rounded to float at the end.
// Source:   depth along the axis or along the ray: the pinhole's definition, and that of HoloLens
//           2's research mode, whose depth is radial.
#pragma once

#include <cstdint>
#include <span>

#include "kernels/cloud/point_cloud.hpp"
#include "kernels/pose/camera_model.hpp"

namespace glint {

enum class DepthAlong : std::uint8_t { axis, ray };

// Metres, row by row, borrowed; 0 or not finite where nothing was measured.
struct DepthPicture {
  int width = 0, height = 0;
  std::span<const float> depth_m;
};

struct DepthPointSettings {
  DepthAlong along = DepthAlong::axis;
  int stride = 1;
  float depth_min_m = 0.1f;
  float depth_max_m = 4.0f;
};

// Looks at pixels [from, from + most) of those that are taken, numbered along the rows; gives the
// first not yet looked at, which is pixels_of() at the end. Adds what does not fit to `dropped`.
[[nodiscard]] int pixels_of(const DepthPicture& picture, int stride) noexcept GLINT_NONBLOCKING;
int add_depth_points(const DepthPicture& picture, const CameraModel& camera,
                     const Pose& T_world_camera, const DepthPointSettings& settings, int from,
                     int most, PointCloud& points, int& dropped) noexcept GLINT_NONBLOCKING;

}  // namespace glint
