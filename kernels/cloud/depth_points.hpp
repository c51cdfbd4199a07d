// Back-projects the pixels of a depth image to points in the world frame.
//
// What:     scales each pixel's ray by its depth, then applies the camera's pose. Takes every
//           stride-th pixel of every stride-th row, row by row.
// Cost:     one unproject() per pixel taken (camera_model.hpp).
// Worst:    discards pixels with a depth outside the limits or without a ray; a full cloud keeps
//           the first points.
// Accuracy: double, rounded to float at the end.
// Source:   depth along the optical axis: definition of the pinhole model; depth along the ray:
//           HoloLens 2 research mode.
#pragma once

#include <cstdint>
#include <span>

#include "kernels/cloud/point_cloud.hpp"
#include "kernels/pose/camera_model.hpp"

namespace glint {

enum class DepthAlong : std::uint8_t { axis, ray };

// Depth image: metres, row-major, borrowed; 0 or not finite where there is no measurement.
struct DepthImageView {
  int width = 0, height = 0;
  std::span<const float> depth_m;
};

struct DepthPointSettings {
  DepthAlong along = DepthAlong::axis;
  int stride = 1;
  float depth_min_m = 0.1f;
  float depth_max_m = 4.0f;
};

// Number of pixels that a stride takes; they are numbered along the rows.
// Processes pixels [from, from + most) of them; returns the first pixel not yet processed, which is
// pixels_of() at the end. Adds the number of points that do not fit to `dropped`.
[[nodiscard]] int pixels_of(const DepthImageView& picture, int stride) noexcept GLINT_NONBLOCKING;
int add_depth_points(const DepthImageView& picture, const CameraModel& camera,
                     const Pose& T_world_camera, const DepthPointSettings& settings, int from,
                     int count_max, PointCloud& points, int& dropped) noexcept GLINT_NONBLOCKING;

}  // namespace glint
