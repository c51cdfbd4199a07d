// Projection of a point onto a local surface through its neighbours: plane fit, then quadratic fit
// (one moving-least-squares projection).
//
// What:     fits a plane to the neighbours by weighted least squares. Over the plane, at the foot
//           of the point, fits a polynomial of order 2 in the plane's two directions; its weights
//           are multiplied by exp(-d^2 / r^2), d the neighbour's distance from the foot. Moves the
//           point onto the polynomial along the plane's normal; the polynomial's normal there
//           becomes the point's.
// Cost:     linear in the neighbours (64 flops each, by fours), and 0.15 us for the two solutions.
// Worst:    fewer than k_quadratic_neighbours_min neighbours, neighbours nearly on a conic, or a
//           polynomial that would move the point further than r: returns the plane's point and
//           normal.
// Accuracy: sums in float, by lanes, of coordinates relative to the point: within 2 um of sums in
//           double at r = 30 mm (local_surface_test.cpp); weights within a relative 3e-6.
// Source:   Alexa et al. 2003, "Computing and rendering point set surfaces", section 4.1, steps 1
//           and 2. Step 1 is without theta and without iteration, as in point cloud libraries; the
//           difference is below the noise.
#pragma once

#include "kernels/cloud/four_floats.hpp"
#include "kernels/geometry.hpp"
#include "kernels/nonblocking.hpp"

namespace glint {

inline constexpr int k_quadratic_neighbours_min = 6;  // number of coefficients of the polynomial
inline constexpr int k_plane_neighbours_min = 3;

// Coordinates relative to the point, which is one of the neighbours. Arrays must be readable
// k_four_padding beyond `count`.
struct Neighbours {
  float* x = nullptr;
  float* y = nullptr;
  float* z = nullptr;
  float* weight = nullptr;
  int count = 0;
};

struct SurfacePoint {
  Vector3 offset_m = Vector3::Zero();  // from the point to its projection on the surface
  Vector3 normal = Vector3::UnitZ();   // sign: z, else y, else x positive
  bool on_polynomial = false;          // on the polynomial, not the plane
};

// Requires at least k_plane_neighbours_min neighbours, all within radius_m. Writes k_four_padding
// zeros beyond `count`.
[[nodiscard]] SurfacePoint local_surface(const Neighbours& neighbours,
                                         float radius_m) noexcept GLINT_NONBLOCKING;

}  // namespace glint
