// ICP correspondences between model and scene points, and their residuals: point-to-point,
// point-to-plane or projective.
//
// What:     three methods behind one call.
//           point:      the nearest scene point; one residual for each of three coordinates.
//           plane:      the nearest scene point; the residual is along the model's normal.
//           projective: the scene point of the same pixel; the residual along the normal is
//                       divided by the cosine between normal and ray, so that every residual has
//                       the noise of depth.
//           Discards pairs farther apart than the gate: hidden points, and points without a scene
//           counterpart. By the first two methods a hidden point could pair with points beside
//           it: it is discarded where its pixel is nearer than the point by more than the gate.
// Cost:     a search in the grid, or one pixel access; one or three rows of the sums.
// Worst:    a search without result visits all cells within the gate.
// Accuracy: that of the pairs. The projective method discards surfaces with a cosine below
//           k_cosine_min: there a fraction of a pixel exceeds the depth noise.
// Source:   Besl and McKay 1992 (point); Chen and Medioni 1992 (plane); Blais and Levine 1995
//           (projective).
#pragma once

#include <cstdint>
#include <span>

#include "kernels/nonblocking.hpp"
#include "kernels/registration/alignment_sums.hpp"
#include "kernels/registration/point_grid.hpp"
#include "kernels/registration/scene_view.hpp"
#include "kernels/registration/visible_points.hpp"

namespace glint {

enum class Matching : std::uint8_t { point, plane, projective };

inline constexpr double k_cosine_min = 0.2;

// Search structure of a view's scene.
struct SceneSearch {
  const PointGrid* grid = nullptr;   // of the scene's points in the camera's frame
  std::span<const Vector3f> points;  // the points that the grid was built from
};

// Adds the pairs of `points`, the visible points at the rendered pose, after the model moved by
// T_moved (camera frame) since. `rotation` and `centroid` transform lever arms and gradients to the
// frame of the sums: x_world = rotation * x_camera, about `centroid` (camera frame).
void add_pairs(std::span<const VisiblePoint> points, const Pose& T_moved, Matching matching,
               double gate_m, const SceneView& view, const SceneSearch& search,
               const Quaternion& rotation, const Vector3& centroid,
               AlignmentSums& sums) noexcept GLINT_NONBLOCKING;

}  // namespace glint
