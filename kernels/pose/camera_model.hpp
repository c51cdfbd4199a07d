// Camera model: pixel to ray and point to pixel, for the lenses of time-of-flight headsets.
//
// What:     unproject: pixel -> unit ray in the camera frame; project: point -> pixel.
// Cost:     pinhole: a division; brown and rational: at most k_ray_steps_max Newton steps; lut: one
//           bilinear look-up to unproject, at most k_lut_search_iterations_max to project.
// Worst:    a pixel or point outside the lens: all iterations, then Reason::out_of_range.
// Accuracy: against OpenCV within 1e-6 px; round trip within 1e-6 px, the table included.
// Source:   pinhole: Puljiz et al., section III (m = (Z x/f, Z y/f, Z)); brown and rational:
//           OpenCV's distortion model with k1,k2,p1,p2,k3,k4,k5,k6; lut: HoloLens 2 research mode's
//           table of unit rays, sampled at pixel centres (integer + 0.5).
#pragma once

#include <array>
#include <cstdint>

#include "kernels/geometry.hpp"
#include "kernels/limits.hpp"
#include "kernels/nonblocking.hpp"
#include "kernels/result.hpp"

namespace glint {

enum class Lens : std::uint8_t { pinhole, brown, rational, lut };

// How the ray of a pixel is found: by a division, by Newton steps on the lens's distortion, in a
// table.
enum class RaySearch : std::uint8_t { none, newton, table };
[[nodiscard]] constexpr RaySearch ray_search_of(Lens lens) noexcept {
  switch (lens) {
    case Lens::pinhole:
      return RaySearch::none;
    case Lens::brown:
    case Lens::rational:
      return RaySearch::newton;
    case Lens::lut:
      return RaySearch::table;
  }
  return RaySearch::none;
}

// Not owned. `height` rows of `width` unit rays (x, y, z), float; zero where the lens maps nothing.
struct RayTable {
  int width = 0;
  int height = 0;
  const float* rays = nullptr;
};

struct CameraModel {
  Lens lens = Lens::pinhole;
  int width = 0;
  int height = 0;
  double fx = 0, fy = 0, cx = 0, cy = 0;  // pixels; of lut: its nearest pinhole
  std::array<double, 8> distortion{};     // k1,k2,p1,p2,k3,k4,k5,k6; brown uses the first five, lut
                                          // all of them for its initial guess
  double field_tangent_max = 0;           // tangent of the widest angle the lens maps; 0: no limit
  RayTable table;                         // lut only
};

inline constexpr int k_lut_search_iterations_max = k_lens_steps_max;

// Returns Reason::out_of_range if the pixel is outside the table, has no ray, or needs more than
// k_ray_steps_max Newton steps.
[[nodiscard]] Result<Vector3> unproject(const CameraModel& camera,
                                        const Vector2& pixel) noexcept GLINT_NONBLOCKING;

// A pixel's unit ray and its derivatives by the pixel, perpendicular to the ray.
struct RayJacobian {
  Vector3 ray = Vector3::UnitZ();
  Vector3 along_x = Vector3::Zero(), along_y = Vector3::Zero();
};
// For every lens but a table, whose derivatives are differences between neighbours. Returns
// Reason::out_of_range if there is no ray or steps_max Newton steps do not find it. Adds the steps
// taken to `lens_steps`.
[[nodiscard]] Result<RayJacobian> unproject_with_jacobian(
    const CameraModel& camera, const Vector2& pixel, int steps_max,
    int& lens_steps) noexcept GLINT_NONBLOCKING;

// Returns Reason::out_of_range if the point is behind the camera or outside the lens. The pixel may
// be outside the frame.
[[nodiscard]] Result<Vector2> project(const CameraModel& camera,
                                      const Vector3& point) noexcept GLINT_NONBLOCKING;
// As above; adds the look-ups in a lens table to `lens_steps`.
[[nodiscard]] Result<Vector2> project(const CameraModel& camera, const Vector3& point,
                                      int& lens_steps) noexcept GLINT_NONBLOCKING;

}  // namespace glint
