// The lens around one pixel, made linear: rays of neighbouring pixels without searching for each.
//
// What:     the ray through a pixel and how it turns from there to its neighbours.
// Cost:     steps_max steps of a lens's polynomial, or at most five look-ups in its
//           table, of which three find a ray.
// Worst:    a pixel at the rim of a wide lens.
// Accuracy: a hundredth of a pixel within 10 px.
// Source:   the lens's own derivative; of a table the difference to a neighbour.
#pragma once

#include "kernels/nonblocking.hpp"
#include "kernels/pose/camera_model.hpp"

namespace glint {

struct LocalRays {
  Vector2 pixel = Vector2::Zero();
  Vector3 ray = Vector3::UnitZ();     // unit
  Vector3 along_x = Vector3::Zero();  // change of the ray by one pixel, at right angles to it
  Vector3 along_y = Vector3::Zero();
  Vector3 outward = Vector3::Zero();  // change of the ray by the focal length, as a ratio

  // Perpendicular distance from the middle ray to the pixel's, at range 1.
  [[nodiscard]] Vector3 sideways(const Vector2& at) const {
    return along_x * (at.x() - pixel.x()) + along_y * (at.y() - pixel.y());
  }
  // principal_px: the pixel of the lens's axis.
  void set_outward(const Vector2& principal_px) { outward = -sideways(principal_px); }
  [[nodiscard]] double steradian_per_pixel() const { return along_x.cross(along_y).norm(); }
};

// Adds the lens's steps to `lens_steps`: a ray looked up in a table is less than two, and leaves
// room for a look-up that ends where a neighbour has none.
[[nodiscard]] Result<LocalRays> local_rays(const CameraModel& camera, const Vector2& pixel,
                                           int steps_max,
                                           int& lens_steps) noexcept GLINT_NONBLOCKING;

inline constexpr int k_lens_steps_a_ray_looked_up = 2;
inline constexpr int k_rays_looked_up_max = 3;  // the middle one and a neighbour in x and y
// What a table takes, whatever steps_max is.
inline constexpr int k_table_ray_steps = k_rays_looked_up_max * k_lens_steps_a_ray_looked_up;
static_assert(k_table_ray_steps <= k_ray_steps_max);

// The steps after which this lens has its rays: the most that any of a grid of pixels over the
// frame takes, and one more; k_ray_steps_max at most. For configuring: as long as some
// thousand rays take.
[[nodiscard]] int ray_steps_needed(const CameraModel& camera) noexcept;

}  // namespace glint
