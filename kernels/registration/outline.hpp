// Whether the scene ends where a model's outline does.
//
// What:     beside each pixel of the model's edge that the scene explains, the nearest measured
//           pixel outside of it: the scene falls away there (farther by far_m), or goes on. What
//           is nearer hides the edge and counts as neither.
// Cost:     a look at each pixel of the picture, up to k_outline_reach at each of the edge.
// Worst:    a model of thin bars: every pixel is an edge on four sides.
// Accuracy: counts. A model off by more than k_outline_from pixels finds itself beside its edge.
// Source:   what tells a thing from a flat one that it lies on: depth is discontinuous at occluding
//           contours, Marr 1977.
#pragma once

#include <cstdint>
#include <span>

#include "kernels/nonblocking.hpp"
#include "kernels/registration/scene_view.hpp"

namespace glint {

// Pixels beside the edge: the first are mixtures of near and far, and room for a model that is a
// little off.
inline constexpr int k_outline_from = 3;
inline constexpr int k_outline_reach = 8;

struct OutlineCounts {
  int falls = 0, goes_on = 0;
};

// model_z and triangle: as render_depth.hpp leaves them, of the view's size.
[[nodiscard]] OutlineCounts look_beside_outline(const SceneView& view,
                                                std::span<const float> model_z,
                                                std::span<const std::int32_t> triangle,
                                                double far_m) noexcept GLINT_NONBLOCKING;

// The same of pixels [from, to), added to the counts.
void add_outline(const SceneView& view, std::span<const float> model_z,
                 std::span<const std::int32_t> triangle, double far_m, int from, int to,
                 OutlineCounts& counts) noexcept GLINT_NONBLOCKING;

}  // namespace glint
