// Renders a triangle mesh into a z-buffer: depth and triangle index of each pixel.
//
// What:     transforms and projects triangles into a z-buffer; 1/z is linear in the image.
// Cost:     a transformation a corner, an edge test a pixel of its bounding box.
// Worst:    triangles that each fill the image: stops after k_render_tests_per_pixel tests a pixel
// of
//           the image (Reason::search_full); the pixels rendered before remain.
// Accuracy: depth to float rounding, a relative 1e-7, at the pixel centres. Discards a triangle
//           with a corner nearer than k_render_near_m.
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
inline constexpr int k_render_tests_per_pixel = 256;

// A corner in the image.
struct ProjectedCorner {
  double u = 0, v = 0, inverse_z = 0;  // pixels, 1/m; 0: not in front of the camera
};

struct DepthBuffer {
  std::span<float> z_m;                // width * height; 0: nothing rendered
  std::span<std::int32_t> triangle;    // same size; -1: nothing rendered
  std::span<ProjectedCorner> corners;  // at least as many as the surface has
};

// Reason::out_of_range: the buffer does not have the camera's size, has too few corners, or a face
// has an invalid corner index.
[[nodiscard]] Reason render_depth(const Surface& model, const Pose& T_camera_model,
                                  const Pinhole& camera,
                                  const DepthBuffer& buffer) noexcept GLINT_NONBLOCKING;

}  // namespace glint
