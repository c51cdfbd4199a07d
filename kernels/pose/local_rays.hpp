// Lens linearised at one pixel: rays of neighbouring pixels without a search for each.
//
// What:     the ray through a pixel and its derivatives by the pixel.
// Cost:     steps_max steps of a lens's polynomial, or at most five look-ups in its table, of which
//           three find a ray.
// Worst:    a pixel at the rim of a wide lens.
// Accuracy: a hundredth of a pixel within 10 px.
// Source:   the lens's own derivative; for a table the difference to a neighbour.
#pragma once

#include "kernels/nonblocking.hpp"
#include "kernels/pose/camera_model.hpp"

namespace glint {

struct LocalRays {
  Vector2 pixel = Vector2::Zero();
  Vector3 ray = Vector3::UnitZ();     // unit
  Vector3 along_x = Vector3::Zero();  // change of the ray per pixel, perpendicular to it
  Vector3 along_y = Vector3::Zero();
  Vector3 outward = Vector3::Zero();  // change of the ray per relative change of the focal length

  // Perpendicular offset of a pixel's ray from the centre ray, at range 1.
  [[nodiscard]] Vector3 perpendicular_offset(const Vector2& at) const {
    return along_x * (at.x() - pixel.x()) + along_y * (at.y() - pixel.y());
  }
  // principal_px: the principal point.
  void set_outward(const Vector2& principal_px) { outward = -perpendicular_offset(principal_px); }
  [[nodiscard]] double steradian_per_pixel() const { return along_x.cross(along_y).norm(); }
};

// Adds the lens's steps to `lens_steps`. A ray found in a table counts as two steps, more than it
// costs; the excess covers a look-up of a neighbour without a ray.
[[nodiscard]] Result<LocalRays> local_rays(const CameraModel& camera, const Vector2& pixel,
                                           int steps_max,
                                           int& lens_steps) noexcept GLINT_NONBLOCKING;

inline constexpr int k_lens_steps_per_table_ray = 2;
inline constexpr int k_table_rays_max = 3;  // the pixel's own and a neighbour in x and y
// Steps of a table, whatever steps_max is.
inline constexpr int k_table_ray_steps = k_table_rays_max * k_lens_steps_per_table_ray;
static_assert(k_table_ray_steps <= k_ray_steps_max);

// Steps that this lens needs for its rays: the maximum over a grid of pixels of the frame, plus
// one, at most k_ray_steps_max. For configuration: costs some thousand rays.
[[nodiscard]] int ray_steps_needed(const CameraModel& camera) noexcept;

}  // namespace glint
