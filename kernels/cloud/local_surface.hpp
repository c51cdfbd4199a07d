// The surface that passes through a point's neighbours: a plane, and a curved sheet over it.
//
// What:     a plane by least squares through the neighbours, each with its weight; over it, at the
// foot of the point, a
//           polynomial of order 2 in the plane's two directions, each neighbour weighted by
//           exp(-d^2 / r^2) too, d its distance from the foot. The point is moved onto the sheet
//           along the plane's normal; the sheet's normal there is the point's.
// Cost:     linear in the neighbours (64 flops each, by fours), and 0.15 us for the two solutions.
// Worst:    fewer than k_sheet_neighbours_min neighbours, all nearly on a conic, or a sheet that
//           would carry the point further than r: the plane stands in for the sheet.
// Accuracy: sums in float, by lanes, of coordinates relative to the point: within 2 um of sums in
//           double at r = 30 mm (local_surface_test.cpp); weights within 3e-6 of their size.
// Source:   Alexa et al. 2003, "Computing and rendering point set surfaces", section 4.1, steps 1
//           and 2, but step 1's plane without theta and not iterated, as point cloud libraries
//           do: nearer than its noise it makes no difference.
#pragma once

#include "kernels/cloud/four_floats.hpp"
#include "kernels/geometry.hpp"
#include "kernels/nonblocking.hpp"

namespace glint {

inline constexpr int k_sheet_neighbours_min = 6;  // as many as the polynomial has coefficients
inline constexpr int k_plane_neighbours_min = 3;

// Relative to the point, which is one of them; readable k_four_spare behind `count`.
struct Neighbours {
  float* x = nullptr;
  float* y = nullptr;
  float* z = nullptr;
  float* weight = nullptr;
  int count = 0;
};

struct SurfacePoint {
  Vector3 offset_m = Vector3::Zero();  // from the point to its place on the surface
  Vector3 normal = Vector3::UnitZ();   // its z, else y, else x positive
  bool curved = false;                 // on the sheet, not the plane
};

// At least k_plane_neighbours_min neighbours, within radius_m. Writes zeros behind the last of
// them.
[[nodiscard]] SurfacePoint local_surface(const Neighbours& neighbours,
                                         float radius_m) noexcept GLINT_NONBLOCKING;

}  // namespace glint
