#include "kernels/pose/systematic_covariance.hpp"

#include <cmath>

#include "kernels/pose/lever_arm.hpp"
#include "kernels/pose/normal_equations.hpp"

namespace glint {
namespace {

using Common = Eigen::Matrix<double, 6, 5>;  // a column a parameter that all markers share

// The sums of one pose.
struct Spread {
  Common common = Common::Zero();
  Matrix6 geometry = Matrix6::Zero(), correlated = Matrix6::Zero();
};

void add_square(const Vector6& column, Matrix6& sum) {
  sum += column.lazyProduct(column.transpose());
}

void add_marker(const WeightedMarker& marker, const LocalRays& rays, const Vector3& point,
                const Vector3& lever, const CameraUncertainty& camera, double marker_sigma_m,
                Spread& spread) {
  const double inverse = 1 / marker.ray.dot(point);
  const double distance = std::sqrt(point.squaredNorm());
  const auto across = [&](const Vector3& direction) -> Vector3 {
    return (direction - marker.ray * (direction.dot(point) * inverse)) * inverse;
  };
  const auto row = [&](const Vector3& gradient) {
    Vector6 out;
    out << gradient, lever.cross(gradient);
    return out;
  };
  const Vector3 gradients[3] = {across(marker.across_first), across(marker.across_second),
                                point * (marker.per_range_sigma / distance)};
  const Vector6 rows[3] = {row(gradients[0]), row(gradients[1]), row(gradients[2])};
  // A residual's change where the measured ray turns by `turn`, or its range grows by 1 m.
  const auto turned = [&](const Vector3& turn) -> Vector6 {
    return rows[0] * marker.across_first.dot(turn) + rows[1] * marker.across_second.dot(turn);
  };
  const Vector6 farther = rows[2] * marker.per_range_sigma;
  const Vector6 right = turned(rays.along_x), down = turned(rays.along_y);
  const Vector3 off_axis(marker.ray.x(), marker.ray.y(), 0);
  spread.common.col(0) += farther * camera.range_offset_m;
  spread.common.col(1) += farther * (camera.range_scale * marker.range_m);
  spread.common.col(2) += right * camera.principal_point_px;
  spread.common.col(3) += down * camera.principal_point_px;
  spread.common.col(4) += turned(off_axis) * camera.focal_scale;
  add_square(farther * camera.slow_range_m, spread.correlated);
  add_square(right * camera.slow_centroid_px, spread.correlated);
  add_square(down * camera.slow_centroid_px, spread.correlated);
  for (int axis = 0; axis < 3; ++axis) {
    const Vector6 moved =
        rows[0] * gradients[0](axis) + rows[1] * gradients[1](axis) + rows[2] * gradients[2](axis);
    add_square(moved * marker_sigma_m, spread.geometry);
  }
}

// Of the reference: N^-1 S N^-1, moved by `lever`.
Matrix6 pose_covariance(const Matrix6& inverse, const Matrix6& spread, const Vector3& lever) {
  const Matrix6 half = inverse.lazyProduct(spread);
  const Matrix6 moved = moved_covariance(half.lazyProduct(inverse), lever);
  return 0.5 * (moved + moved.transpose());
}

}  // namespace

Result<SystematicCovariance> systematic_covariance(std::span<const WeightedMarker> markers,
                                                   std::span<const LocalRays> rays,
                                                   const Pose& T_camera_tool,
                                                   const Vector3& reference_m,
                                                   const CameraUncertainty& camera,
                                                   double marker_sigma_m) noexcept {
  const Result<SystematicCovariance> none{{}, Reason::degenerate};
  if (markers.empty() || rays.size() != markers.size()) return none;
  const Vector3 mean_m = mean_of(markers);
  NormalEquations normal;
  if (!add_markers(markers, T_camera_tool, mean_m, normal)) return none;
  const Result<PoseFactor> factor = pose_factor(normal.matrix);
  if (!factor) return none;
  Spread spread;
  for (std::size_t i = 0; i < markers.size(); ++i) {
    const WeightedMarker& marker = markers[i];
    const Vector3 lever = T_camera_tool.rotation * (marker.model_m - mean_m);
    add_marker(marker, rays[i], T_camera_tool * marker.model_m, lever, camera, marker_sigma_m,
               spread);
  }
  const Matrix6 inverse = factor.value.inverse();
  const Vector3 lever = T_camera_tool.rotation * (reference_m - mean_m);
  const Matrix6 constant = spread.geometry + spread.common.lazyProduct(spread.common.transpose());
  Result<SystematicCovariance> out;
  out.value.calibration = pose_covariance(inverse, constant, lever);
  const Matrix6 correlated = pose_covariance(inverse, spread.correlated, lever);
  out.value.correlated = {camera.fast_share * correlated, (1 - camera.fast_share) * correlated};
  return std::isfinite(out.value.calibration.sum() + correlated.sum()) ? out : none;
}

}  // namespace glint
