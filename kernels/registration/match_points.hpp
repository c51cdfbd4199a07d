// Which point of the scene belongs to a point of the model, and what their distance pulls at.
//
// What:     three ways behind one call.
//           point:      the nearest scene point; its three coordinates pull alike.
//           plane:      the nearest scene point; only what is along the model's normal pulls.
//           projective: the scene point of the same pixel; along the normal, divided by the cosine
//                       between normal and ray: then all pull as exactly as depth is measured.
//           A pair farther apart than the gate pulls nothing: what is hidden behind something
//           nearer is left out so, and what the scene does not have. By the first two ways a
//           hidden point would find neighbours aside: it is left out where its pixel is nearer by
//           more than the gate.
// Cost:     a search in the grid, or a look into the picture; one or three rows of the sums.
// Worst:    a search that finds nothing looks at all cells within the gate.
// Accuracy: that of the pairs; a surface that is seen at less than k_least_cosine is left out by
//           the projective way: there a part of a pixel is more than depth's noise.
// Source:   Besl and McKay 1992 (point); Chen and Medioni 1992 (plane); Blais and Levine 1995
//           (projective).
#pragma once

#include <cstdint>
#include <span>

#include "kernels/nonblocking.hpp"
#include "kernels/registration/alignment_sums.hpp"
#include "kernels/registration/point_grid.hpp"
#include "kernels/registration/scene_view.hpp"
#include "kernels/registration/seen_points.hpp"

namespace glint {

enum class Matching : std::uint8_t { point, plane, projective };

inline constexpr double k_least_cosine = 0.2;

// What is known of a view's scene.
struct SceneSearch {
  const PointGrid* grid = nullptr;   // of the scene's points in the camera's frame
  std::span<const Vector3f> points;  // those that the grid was built of
};

// Adds the pairs of these points, seen in the view from where the model stood then, after it moved
// by T_moved (in the camera's frame) since. `turn` and `middle` bring levers and gradients into the
// frame of the sums: x_world = turn * x_camera, about the middle, which is in the camera's frame.
void add_pairs(std::span<const SeenPoint> points, const Pose& T_moved, Matching matching,
               double gate_m, const SceneView& view, const SceneSearch& search,
               const Quaternion& turn, const Vector3& middle,
               AlignmentSums& sums) noexcept GLINT_NONBLOCKING;

}  // namespace glint
