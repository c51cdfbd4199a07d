// Reprojection residual of a lens model (brown or rational), in pixels.
//
// What:     the pixel of a point on the plane z = 1 by the brown or rational lens, minus the
//           measured pixel. Pixel centres are at integer + 0.5.
// Cost:     no loop, one division.
// Worst:    a denominator of zero: a lens far from any fit.
// Accuracy: equal to camera_model.hpp's projection up to rounding.
// Source:   OpenCV's distortion model: (1 + k1 r2 + k2 r4 + k3 r6) / (1 + k4 r2 + k5 r4 + k6 r6),
//           tangential p1, p2; brown is the one with k4 = k5 = k6 = 0.
#pragma once

#include "kernels/calibrate/scalar.hpp"

namespace glint {

// fx, fy, cx, cy, then k1, k2, p1, p2, k3, k4, k5, k6.
inline constexpr int k_lens_numbers = 12;

template <class Scalar>
[[nodiscard]] Vector2Of<Scalar> lens_residual(const Vector2& plane, const Vector2& pixel,
                                              const Scalar* lens) noexcept {
  const double x = plane.x(), y = plane.y(), r2 = x * x + y * y;
  const Scalar* d = lens + 4;
  const Scalar above = Scalar(1) + r2 * (d[0] + r2 * (d[1] + r2 * d[4]));
  const Scalar below = Scalar(1) + r2 * (d[5] + r2 * (d[6] + r2 * d[7]));
  const Scalar radial = above / below;
  const Scalar u = x * radial + 2 * x * y * d[2] + (r2 + 2 * x * x) * d[3];
  const Scalar v = y * radial + (r2 + 2 * y * y) * d[2] + 2 * x * y * d[3];
  return {lens[0] * u + lens[2] - pixel.x(), lens[1] * v + lens[3] - pixel.y()};
}

}  // namespace glint
