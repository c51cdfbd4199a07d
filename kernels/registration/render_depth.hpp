// What a camera could see of a model: depth and triangle of each pixel.
//
// What:     triangles, transformed and projected, into a z-buffer; 1/z is linear in the picture.
// Cost:     a transformation a corner, an edge test a pixel of its box.
// Worst:    triangles that each fill the picture: ended after k_render_tests_a_pixel tests a pixel
//           of the picture (Reason::search_full), what is rendered by then stands.
// Accuracy: depth to float's rounding, 1e-7 of it, at the pixels' centres. A triangle that reaches
//           nearer than k_render_near_m is left out.
// Source:   Catmull 1974 (z-buffer); Pineda 1988 (edge functions).
#pragma once

#include <cstdint>
#include <span>

#include "kernels/nonblocking.hpp"
#include "kernels/reason.hpp"
#include "kernels/registration/triangle.hpp"

namespace glint {

inline constexpr double k_render_near_m = 0.05;
// A robot's 40,000 triangles take 3 to 8.
inline constexpr int k_render_tests_a_pixel = 256;

// A corner in the picture.
struct ProjectedCorner {
  double u = 0, v = 0, inverse_z = 0;  // pixels, 1/m; 0: not in front of the camera
};

struct DepthBuffer {
  std::span<float> z_m;                // width * height, 0 where nothing is
  std::span<std::int32_t> triangle;    // as many, -1 where nothing is
  std::span<ProjectedCorner> corners;  // at least as many as the surface has
};

// Reason::out_of_range: the buffer does not have the camera's size, has
// too few corners, or a face names a corner that is not there.
[[nodiscard]] Reason render_depth(const Surface& model, const Pose& T_camera_model,
                                  const Pinhole& camera,
                                  const DepthBuffer& buffer) noexcept GLINT_NONBLOCKING;

}  // namespace glint
