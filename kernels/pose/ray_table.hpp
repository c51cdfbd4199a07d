// Lens model as a table of unit rays, one at each pixel's centre.
//
// What:     unproject interpolates bilinearly between the four nearest rays and normalises. project
//           searches the pixel whose ray meets the point, by Newton's method with the derivatives
//           of the current cell.
// Cost:     one look-up; project at most k_lut_search_iterations_max look-ups.
// Worst:    a point outside the table: all iterations.
// Accuracy: exact at pixel centres; between them limited by the lens's curvature over a pixel (5e-6
//           rad for a HoloLens 2). Round trip within 1e-6 px, except for the outermost pixels of
//           the lens circle, which project may not find.
// Source:   HoloLens 2 research mode gives MapImagePointToCameraUnitPlane at pixel centres.
#pragma once

#include "kernels/nonblocking.hpp"
#include "kernels/pose/camera_model.hpp"

namespace glint {

// Extrapolates the nearest cell within half a pixel of the border. Returns Reason::out_of_range if
// the pixel is outside the table or a ray that it needs is zero.
[[nodiscard]] Result<Vector3> unproject(const RayTable& table,
                                        const Vector2& pixel) noexcept GLINT_NONBLOCKING;

// start: initial guess, e.g. the pixel by a fitted lens; middle: a pixel that has a ray. Returns
// Reason::out_of_range if no pixel of the table has this ray. Adds its look-ups to `steps`.
[[nodiscard]] Result<Vector2> project(const RayTable& table, const Vector3& point,
                                      const Vector2& start, const Vector2& middle,
                                      int& steps) noexcept GLINT_NONBLOCKING;

}  // namespace glint
