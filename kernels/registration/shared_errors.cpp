#include "kernels/registration/shared_errors.hpp"

#include <array>
#include <cmath>

#include "kernels/registration/match_points.hpp"

namespace glint {
namespace {

constexpr std::size_t k_depth_errors = 3;  // a constant and two slopes

struct ConsiderSums {
  Matrix6 matrix = Matrix6::Zero();
  std::array<Vector6, k_depth_errors> errors{Vector6::Zero(), Vector6::Zero(), Vector6::Zero()};
};

void add_view(const SceneView& view, const Pose& T_world_base, double gate_m,
              AlignmentScratch::View& memory, ConsiderSums& sums) noexcept {
  render_model(view, T_world_base, 1, memory);
  const Matrix3 to_world = view.T_camera_world.inverse().rotation.toRotationMatrix();
  const Vector3 origin = view.T_camera_world * T_world_base.translation;
  const double half_width = 0.5 * view.camera.width, half_height = 0.5 * view.camera.height;
  for (int i = 0; i < memory.visible_count; ++i) {
    const VisiblePoint& seen = memory.seen[static_cast<std::size_t>(i)];
    const auto pixel = static_cast<std::size_t>(seen.pixel);
    const Vector3 p = seen.point.cast<double>(), normal = seen.normal.cast<double>();
    const double z = static_cast<double>(view.depth_m[pixel]);
    const double range = p.norm(), cosine = -normal.dot(p) / range;
    if (!(z > 0) || !view.may_be_model(pixel) || !(std::abs(p.z() - z) <= gate_m) ||
        cosine < k_cosine_min) {
      continue;
    }
    // The projective pair of match_points.cpp; its residual is that of a depth error of one metre.
    AlignmentSums pair;
    pair.add(to_world * (p - origin), to_world * normal * (-1 / cosine), range / p.z(), 1);
    sums.matrix += pair.matrix;
    sums.errors[0] += pair.slope;
    sums.errors[1] += pair.slope * ((seen.pixel % view.camera.width + 0.5) / half_width - 1);
    sums.errors[2] += pair.slope * ((seen.pixel / view.camera.width + 0.5) / half_height - 1);
  }
}

// A rotation of a view's rays about one of its axes rotates the base about the camera.
Matrix6 rotated_rays(const SceneView& view, const Pose& T_world_base) noexcept {
  const Pose T_world_camera = view.T_camera_world.inverse();
  const Vector3 lever = T_world_base.translation - T_world_camera.translation;
  Matrix6 sum = Matrix6::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3 rotation = T_world_camera.rotation * Vector3::Unit(axis);
    Vector6 moves;
    moves << rotation.cross(lever), rotation;
    sum += moves * moves.transpose();
  }
  return sum;
}

}  // namespace

Result<Matrix6> consider_covariance(std::span<const SceneView> views, const Pose& T_world_base,
                                    double gate_m, const SystematicErrors& errors,
                                    AlignmentScratch& scratch) noexcept {
  if (!scene_fits(views, scratch)) return {{}, Reason::not_prepared};
  ConsiderSums sums;
  for (std::size_t v = 0; v < views.size(); ++v) {
    add_view(views[v], T_world_base, gate_m, scratch.views[v], sums);
  }
  const Result<PoseFactor> factor = pose_factor(sums.matrix);
  if (!factor) return {{}, Reason::degenerate};
  Matrix6 covariance = Matrix6::Zero();
  for (const Vector6& error : sums.errors) {
    const Vector6 moves = factor.value.solve(error) * errors.depth_sigma_m;
    covariance += moves * moves.transpose();
  }
  const double ray = errors.ray_sigma_rad * errors.ray_sigma_rad;
  return {covariance + ray * rotated_rays(views[0], T_world_base), Reason::none};
}

}  // namespace glint
