// Offset of a sphere's image centroid from the projection of the sphere's centre (eccentricity
// correction).
//
// What:     the silhouette is a cone about the ray to the centre. Off the axis the lens stretches
//           its outer half more than the inner one, and the centroid moves. sphere_offset tabulates
//           the offset for a lens, offset_px interpolates it.
// Cost:     offset_px: an interpolation; sphere_offset: a dozen rays per entry, once.
// Worst:    data independent.
// Accuracy: second order in the angular radius, for an evenly bright sphere and a rotationally
//           symmetric lens: 0.01 px. If the limb returns 0.6 of the light, a sixteenth of the
//           offset remains: for 5.5 mm at 0.3 m, 45 degrees off the axis, f = 253 px, 0.011 of 0.16
//           px.
// Source:   the mean of p(w) J(w) over a small cap of directions w about the centre's, p the
//           projection and J = |dp/dw|, to second order in w; for a pinhole it is the centre of the
//           silhouette's ellipse, f a^2 tan(t) / cos^2(t).
#pragma once

#include <array>

#include "kernels/geometry.hpp"
#include "kernels/nonblocking.hpp"
#include "kernels/pose/camera_model.hpp"

namespace glint {

inline constexpr int k_sphere_shift_entries = 33;

// Table by the squared distance from the principal point, in equal steps.
struct SphereOffset {
  Vector2 axis_px = Vector2::Zero();
  double entries_per_square_px = 0;
  // Offset divided by the distance from the axis and by the squared sine of the angular radius.
  std::array<double, k_sphere_shift_entries> gain{};
};

[[nodiscard]] SphereOffset sphere_offset(const CameraModel& camera) noexcept GLINT_NONBLOCKING;

// Returns the offset to subtract from the centroid. sine: of the sphere's angular radius, its
// radius divided by its range.
[[nodiscard]] Vector2 offset_px(const SphereOffset& shift, const Vector2& centroid_px,
                                double sine) noexcept GLINT_NONBLOCKING;

}  // namespace glint
