#include "kernels/pose/systematic_covariance.hpp"

#include <cmath>

#include "kernels/pose/lever_arm.hpp"
#include "kernels/pose/marker_slopes.hpp"
#include "kernels/pose/normal_equations.hpp"

namespace glint {
namespace {

using Common = Eigen::Matrix<double, 6, 5>;  // one column per parameter common to all markers

// Sums over the markers of one pose.
struct Spread {
  Common common = Common::Zero();
  Matrix6 geometry = Matrix6::Zero(), correlated = Matrix6::Zero();
};

void add_square(const Vector6& column, Matrix6& sum) {
  sum += column.lazyProduct(column.transpose());
}

void add_marker(const MarkerSensitivity& slopes, double range_m, const CameraUncertainty& camera,
                double marker_sigma_m, Spread& spread) {
  spread.common.col(0) += slopes.by_range * camera.range_offset_m;
  spread.common.col(1) += slopes.by_range * (camera.range_scale * range_m);
  spread.common.col(2) += slopes.by_pixel_x * camera.principal_point_px;
  spread.common.col(3) += slopes.by_pixel_y * camera.principal_point_px;
  spread.common.col(4) += slopes.by_focal * camera.focal_scale;
  add_square(slopes.by_range * camera.correlated_range_m, spread.correlated);
  add_square(slopes.by_pixel_x * camera.correlated_centroid_px, spread.correlated);
  add_square(slopes.by_pixel_y * camera.correlated_centroid_px, spread.correlated);
  for (int axis = 0; axis < 3; ++axis)
    add_square(slopes.by_position.col(axis) * marker_sigma_m, spread.geometry);
}

// Covariance of the reference: N^-1 S N^-1, moved by `lever`.
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
    const MarkerSensitivity slopes =
        marker_sensitivity(marker, rays[i], T_camera_tool * marker.model_m, lever);
    add_marker(slopes, marker.range_m, camera, marker_sigma_m, spread);
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
