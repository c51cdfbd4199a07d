// Occluding-contour test: counts whether the scene's depth falls away beside a model's outline.
//
// What:     for each pixel of the model's edge that the scene explains, reads the nearest measured
//           pixel outside the model. The scene falls away there (farther by far_m), or goes on. A
//           nearer pixel hides the edge and counts as neither.
// Cost:     one access to each pixel of the image, up to k_outline_reach at each edge pixel.
// Worst:    a model of thin bars: every pixel is an edge on four sides.
// Accuracy: counts. With a pose error above k_outline_from pixels the object itself appears beside
//           the outline.
// Source:   depth is discontinuous at occluding contours, Marr 1977; this separates an object from
//           a flat one that is part of a surface.
#pragma once

#include <cstdint>
#include <span>

#include "kernels/nonblocking.hpp"
#include "kernels/registration/scene_view.hpp"

namespace glint {

// Pixels beside the edge that are read. Nearer ones are mixed pixels, and the margin for a small
// pose error.
inline constexpr int k_outline_from = 3;
inline constexpr int k_outline_reach = 8;

struct OutlineCounts {
  int falls = 0, continues = 0;
};

// model_z and triangle: output of render_depth.hpp, of the view's size.
[[nodiscard]] OutlineCounts count_outline(const SceneView& view, std::span<const float> model_z,
                                          std::span<const std::int32_t> triangle,
                                          double far_m) noexcept GLINT_NONBLOCKING;

// The same for the pixels [from, to), added to the counts.
void add_outline(const SceneView& view, std::span<const float> model_z,
                 std::span<const std::int32_t> triangle, double far_m, int from, int to,
                 OutlineCounts& counts) noexcept GLINT_NONBLOCKING;

}  // namespace glint
