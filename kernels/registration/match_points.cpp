#include "kernels/registration/match_points.hpp"

#include <cmath>

namespace glint {
namespace {

// Pixel that contains a point's projection; -1: none.
int pixel_of(const Pinhole& camera, const Vector3& p) noexcept {
  if (!(p.z() > k_render_near_m)) return -1;
  const double u = camera.fx * p.x() / p.z() + camera.cx;
  const double v = camera.fy * p.y() / p.z() + camera.cy;
  if (!(u >= 0 && v >= 0 && u < camera.width && v < camera.height)) return -1;
  return static_cast<int>(v) * camera.width + static_cast<int>(u);
}

// Returns true if the measured depth at a point's pixel is nearer than the point by more than the
// gate (occlusion).
bool occluded(const SceneView& view, const Vector3& p, double gate_m) noexcept {
  const int pixel = pixel_of(view.camera, p);
  if (pixel < 0) return false;
  const double z = static_cast<double>(view.depth_m[static_cast<std::size_t>(pixel)]);
  return z > 0 && z < p.z() - gate_m;
}

}  // namespace

void add_pairs(std::span<const VisiblePoint> points, const Pose& T_moved, Matching matching,
               double gate_m, const SceneView& view, const SceneSearch& search,
               const Quaternion& rotation, const Vector3& centroid, AlignmentSums& sums) noexcept {
  const Matrix3 moved = T_moved.rotation.toRotationMatrix(), to_world = rotation.toRotationMatrix();
  for (const VisiblePoint& seen : points) {
    const Vector3 p = moved * seen.point.cast<double>() + T_moved.translation;
    const Vector3 normal = moved * seen.normal.cast<double>();
    const Vector3 lever = to_world * (p - centroid);
    if (matching == Matching::projective) {
      const int pixel = pixel_of(view.camera, p);
      if (pixel < 0 || !view.may_be_model(static_cast<std::size_t>(pixel))) continue;
      const double z = static_cast<double>(view.depth_m[static_cast<std::size_t>(pixel)]);
      const double away = p.z() - z;
      if (!(z > 0) || !(std::abs(away) <= gate_m)) continue;
      const double range = p.norm(), cosine = -normal.dot(p) / range;
      if (cosine < k_cosine_min) continue;
      sums.add(lever, to_world * normal * (-1 / cosine), away * range / p.z(), 1);
      continue;
    }
    if (occluded(view, p, gate_m)) continue;
    const Nearest nearest = search.grid->nearest(p.cast<float>(), static_cast<float>(gate_m));
    if (nearest.index < 0) continue;
    const Vector3 difference =
        p - search.points[static_cast<std::size_t>(nearest.index)].cast<double>();
    if (matching == Matching::plane) {
      sums.add(lever, to_world * normal, normal.dot(difference), 1);
    } else {
      const Vector3 residual = to_world * difference;
      for (int k = 0; k < 3; ++k) sums.add(lever, Vector3::Unit(k), residual(k), 1);
    }
  }
}

}  // namespace glint
