// How far a sphere's image has its middle beside the projection of the sphere's centre.
//
// What:     the silhouette is a cone about the ray to the centre; off the axis the lens stretches
//           its outer half more than the inner one, and the mean of its pixels moves. sphere_shift
//           tables that for a lens, shift_px looks it up.
// Cost:     shift_px: an interpolation; sphere_shift: a dozen rays an entry, once.
// Worst:    none is worse than another.
// Accuracy: second order in the angular radius, for an evenly bright sphere and a lens that is
//           alike all round: 0.01 px. Of one whose limb sends back 0.6 of the light a sixteenth of
//           the shift is left: 5.5 mm at 0.3 m, 45 degrees off, f = 253 px: 0.16 become 0.011 px.
// Source:   the mean of p(w) J(w) over a small cap of directions w about the centre's, p the
//           projection and J = |dp/dw|, to second order in w; of a pinhole it is the middle of the
//           silhouette's ellipse, f a^2 tan(t) / cos^2(t).
#pragma once

#include <array>

#include "kernels/geometry.hpp"
#include "kernels/nonblocking.hpp"
#include "kernels/pose/camera_model.hpp"

namespace glint {

inline constexpr int k_sphere_shift_entries = 33;

// By the squared distance from the axis's pixel, in even steps.
struct SphereShift {
  Vector2 axis_px = Vector2::Zero();
  double entries_per_square_px = 0;
  // Shift by distance from the axis, a unit of the angular radius's squared sine.
  std::array<double, k_sphere_shift_entries> gain{};
};

[[nodiscard]] SphereShift sphere_shift(const CameraModel& camera) noexcept GLINT_NONBLOCKING;

// To be taken off the centroid. sine: of the sphere's angular radius, its radius by its range.
[[nodiscard]] Vector2 shift_px(const SphereShift& shift, const Vector2& centroid_px,
                               double sine) noexcept GLINT_NONBLOCKING;

}  // namespace glint
