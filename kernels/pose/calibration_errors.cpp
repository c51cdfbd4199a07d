#include "kernels/pose/calibration_errors.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "kernels/motion/interpolate.hpp"
#include "kernels/pose/lever_arm.hpp"
#include "kernels/pose/normal_equations.hpp"

namespace glint {
namespace {

// One residual: its value, its derivatives by the pose (normal_equations.hpp), and the negative
// derivatives by the errors, in sigmas.
struct Row {
  double residual = 0;
  Vector6 by_pose = Vector6::Zero();
  ErrorVector by_errors = ErrorVector::Zero();
};
using Rows = std::array<Row, 3 * k_markers_per_tool_max>;

// Limits of chi-square: of the noise (42 degrees of freedom, significance level 1e-3: 16 markers),
// plus that of errors so many times their declared size. Above the sum, the labeling or the minimum
// is wrong.
constexpr double k_noise_chi_square_max = 76, k_errors_max = 8;

// Number of neighbouring fits that share a lens residual, and a part of the range ripple.
constexpr double k_fits_per_residual = 4, k_fits_per_ripple = 16;

double square_of(double x) { return x * x; }

// Quantities common to all residuals of a marker.
struct MarkerGeometry {
  const LocalRays& rays;
  Matrix3 rotation;
  Vector3 lever;
  int number;
};

void set_row(double residual, const Vector3& gradient, const MarkerGeometry& geometry,
             double marker_sigma_m, Row& row) {
  row.residual = residual;
  row.by_pose << gradient, geometry.lever.cross(gradient);
  row.by_errors.setZero();
  row.by_errors.segment<3>(k_common_errors + 3 * geometry.number) =
      marker_sigma_m * (geometry.rotation.transpose() * gradient);
}

// Residual perpendicular to the ray, along `across`; camera errors rotate the measured ray.
void set_across(const Vector3& across, const WeightedMarker& marker, const Vector3& point,
                const MarkerGeometry& geometry, const CameraUncertainty& camera,
                double marker_sigma_m, Row& row) {
  const double inverse = 1 / marker.ray.dot(point);
  const double residual = across.dot(point) * inverse;
  set_row(residual, (across - marker.ray * residual) * inverse, geometry, marker_sigma_m, row);
  const double right = across.dot(geometry.rays.along_x), down = across.dot(geometry.rays.along_y);
  row.by_errors(2) = right * camera.principal_point_px;
  row.by_errors(3) = down * camera.principal_point_px;
  row.by_errors(4) = across.dot(geometry.rays.outward) * camera.focal_scale;
  const double slow_px2 = square_of(camera.correlated_centroid_px) +
                          k_fits_per_residual * square_of(k_lens_residual_px);
  const double noise = std::sqrt(1 + slow_px2 * (square_of(right) + square_of(down)));
  row.residual /= noise;
  row.by_pose /= noise;
  row.by_errors /= noise;
}

void set_along(const WeightedMarker& marker, const Vector3& point, const MarkerGeometry& geometry,
               const CameraUncertainty& camera, double marker_sigma_m, Row& row) {
  const double slow_m2 =
      square_of(camera.correlated_range_m) + k_fits_per_ripple * square_of(k_range_ripple_m);
  const double weight =
      marker.per_range_sigma / std::sqrt(1 + slow_m2 * square_of(marker.per_range_sigma));
  const double range = std::sqrt(point.squaredNorm());
  set_row((range - marker.range_m) * weight, point * (weight / range), geometry, marker_sigma_m,
          row);
  row.by_errors(0) = weight * camera.range_offset_m;
  row.by_errors(1) = weight * marker.range_m * camera.range_scale;
}

}  // namespace

Result<OptimalFit> add_fit(std::span<const WeightedMarker> markers, std::span<const LocalRays> rays,
                           std::span<const int> of_tool, const Pose& T_camera_tool,
                           const CameraUncertainty& camera, double marker_sigma_m,
                           CalibrationErrors* errors) noexcept {
  const std::size_t count = std::min(markers.size(), std::size_t{k_markers_per_tool_max});
  if (count < 3 || rays.size() < count || of_tool.size() < count) return {{}, Reason::degenerate};
  const Vector3 mean_m = mean_of(markers.first(count));
  const Matrix3 rotation = T_camera_tool.rotation.toRotationMatrix();
  Rows rows;
  Matrix6 normal = Matrix6::Zero();
  double range_m = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const WeightedMarker& marker = markers[i];
    const Vector3 point = T_camera_tool * marker.model_m;
    if (!(marker.ray.dot(point) > 0) || of_tool[i] < 0 || of_tool[i] >= k_markers_per_tool_max)
      return {{}, Reason::degenerate};
    const MarkerGeometry geometry{rays[i], rotation, rotation * (marker.model_m - mean_m),
                                  of_tool[i]};
    set_across(marker.across_first, marker, point, geometry, camera, marker_sigma_m, rows[3 * i]);
    set_across(marker.across_second, marker, point, geometry, camera, marker_sigma_m,
               rows[3 * i + 1]);
    set_along(marker, point, geometry, camera, marker_sigma_m, rows[3 * i + 2]);
    for (std::size_t k = 3 * i; k < 3 * i + 3; ++k)
      normal += rows[k].by_pose.lazyProduct(rows[k].by_pose.transpose());
    range_m += marker.range_m;
  }
  const Result<PoseFactor> factor = pose_factor(normal);
  if (!factor) return {{}, Reason::degenerate};
  // Remove from each column the part that the pose explains.
  Vector6 residual_pose = Vector6::Zero();
  Eigen::Matrix<double, 6, k_calibration_errors> pose_by_errors;
  pose_by_errors.setZero();
  for (std::size_t k = 0; k < 3 * count; ++k) {
    residual_pose += rows[k].by_pose * rows[k].residual;
    for (int c = 0; c < k_calibration_errors; ++c)
      pose_by_errors.col(c) += rows[k].by_pose * rows[k].by_errors(c);
  }
  residual_pose = factor.value.solve(residual_pose);
  for (int c = 0; c < k_calibration_errors; ++c)
    pose_by_errors.col(c) = factor.value.solve(pose_by_errors.col(c));
  double left_squares = 0, error_squares = 0;
  for (std::size_t k = 0; k < 3 * count; ++k) {
    Row& row = rows[k];
    row.residual -= row.by_pose.dot(residual_pose);
    for (int c = 0; c < k_calibration_errors; ++c)
      row.by_errors(c) -= row.by_pose.dot(pose_by_errors.col(c));
    left_squares += row.residual * row.residual;
    error_squares += row.by_errors.squaredNorm();
  }
  if (!(left_squares <= k_noise_chi_square_max + k_errors_max * k_errors_max * error_squares))
    return {{}, Reason::bad_fit};
  if (errors != nullptr) {
    for (std::size_t k = 0; k < 3 * count; ++k) {
      const ErrorVector& left = rows[k].by_errors;
      for (int c = 0; c < k_calibration_errors; ++c) {
        errors->information_vector(c) -= left(c) * rows[k].residual;
        for (int r = c; r < k_calibration_errors; ++r)
          errors->information(r, c) += left(r) * left(c);
      }
    }
    errors->ranges_m += range_m / static_cast<double>(count);
    ++errors->fits;
  }
  // Move the reference from the markers' mean to the tool's origin.
  const Quaternion turn = from_rotation_vector(-residual_pose.tail<3>());
  const Vector3 mean = T_camera_tool * mean_m - residual_pose.head<3>();
  OptimalFit fit;
  fit.T_camera_tool.rotation = (turn * T_camera_tool.rotation).normalized();
  const Vector3 lever = -(fit.T_camera_tool.rotation * mean_m);
  fit.T_camera_tool.translation = mean + lever;
  fit.covariance = moved_covariance(factor.value.inverse(), lever);
  fit.by_errors = pose_by_pose(lever).lazyProduct(pose_by_errors.leftCols<k_common_errors>());
  return {fit};
}

}  // namespace glint
