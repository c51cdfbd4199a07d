// The lens around one pixel, made linear: rays of neighbouring pixels without searching for each.
//
// Accuracy: a hundredth of a pixel within 10 px.
#pragma once

#include "kernels/pose/camera_model.hpp"

namespace glint {

struct LocalRays {
  Vector2 pixel = Vector2::Zero();
  Vector3 ray = Vector3::UnitZ();     // unit
  Vector3 along_x = Vector3::Zero();  // change of the ray by one pixel, at right angles to it
  Vector3 along_y = Vector3::Zero();

  // Perpendicular distance from the middle ray to the pixel's, at range 1.
  [[nodiscard]] Vector3 sideways(const Vector2& at) const {
    return along_x * (at.x() - pixel.x()) + along_y * (at.y() - pixel.y());
  }
  [[nodiscard]] double steradian_per_pixel() const { return along_x.cross(along_y).norm(); }
};

[[nodiscard]] Result<LocalRays> local_rays(const CameraModel& camera,
                                           const Vector2& pixel) noexcept;

}  // namespace glint
