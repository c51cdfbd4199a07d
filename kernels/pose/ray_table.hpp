// A lens given as a table of unit rays, one at each pixel's centre.
//
// What:     bilinear between the four nearest rays, made unit again; project searches the pixel
//           whose ray meets the point, by Newton's method with the slopes of the cell it is in.
// Cost:     one look-up; project at most k_lut_search_iterations_max look-ups.
// Worst:    a point outside the table: all iterations.
// Accuracy: exact at pixel centres; between them as good as the lens is flat over a pixel (5e-6 rad
//           for a HoloLens 2). There and back within 1e-6 px,
//           but for the outermost pixels of the lens circle, which project may not find.
// Source:   HoloLens 2 research mode gives MapImagePointToCameraUnitPlane at pixel centres.
#pragma once

#include "kernels/nonblocking.hpp"
#include "kernels/pose/camera_model.hpp"

namespace glint {

// Within half a pixel of the border the nearest cell is extended. Reason::out_of_range: outside the
// table, or a ray that it needs is zero.
[[nodiscard]] Result<Vector3> unproject(const RayTable& table,
                                        const Vector2& pixel) noexcept GLINT_NONBLOCKING;

// start: where to begin, e.g. the pixel by a fitted lens; middle: a pixel that surely has a ray.
// Reason::out_of_range: no pixel of the table has this ray. Adds its look-ups to `steps`.
[[nodiscard]] Result<Vector2> project(const RayTable& table, const Vector3& point,
                                      const Vector2& start, const Vector2& middle,
                                      int& steps) noexcept GLINT_NONBLOCKING;

}  // namespace glint
