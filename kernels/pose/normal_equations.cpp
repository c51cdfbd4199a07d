#include "kernels/pose/normal_equations.hpp"

#include <cmath>

namespace glint {
namespace {

// Minimum depth of a point along its measured ray, as a part of the measured range.
constexpr double k_depth_part_min = 0.1;

// Sums of one marker: gradient * gradient' (its lower triangle) and gradient * residual. The
// rotation part of every row is lever x gradient, so it is computed once per marker.
struct PointSums {
  double xx = 0, yx = 0, zx = 0, yy = 0, zy = 0, zz = 0;
  Vector3 gradient_sum = Vector3::Zero();
  double squares = 0;

  void add(double residual, const Vector3& gradient) {
    xx += gradient.x() * gradient.x();
    yx += gradient.y() * gradient.x();
    zx += gradient.z() * gradient.x();
    yy += gradient.y() * gradient.y();
    zy += gradient.z() * gradient.y();
    zz += gradient.z() * gradient.z();
    gradient_sum += gradient * residual;
    squares += residual * residual;
  }
};

void add_point(const PointSums& sums, const Vector3& lever, NormalEquations& normal) {
  const Vector3 x(sums.xx, sums.yx, sums.zx), y(sums.yx, sums.yy, sums.zy),
      z(sums.zx, sums.zy, sums.zz);
  // Columns of [lever]x A; the cross product of its rows with the lever gives [lever]x A [lever]x'.
  const Vector3 turn_x = lever.cross(x), turn_y = lever.cross(y), turn_z = lever.cross(z);
  Matrix6& m = normal.matrix;
  m(0, 0) += sums.xx;
  m(1, 0) += sums.yx;
  m(2, 0) += sums.zx;
  m(1, 1) += sums.yy;
  m(2, 1) += sums.zy;
  m(2, 2) += sums.zz;
  m.block<3, 1>(3, 0) += turn_x;
  m.block<3, 1>(3, 1) += turn_y;
  m.block<3, 1>(3, 2) += turn_z;
  const Vector3 row_x(turn_x.x(), turn_y.x(), turn_z.x()),
      row_y(turn_x.y(), turn_y.y(), turn_z.y()), row_z(turn_x.z(), turn_y.z(), turn_z.z());
  const Vector3 twice_x = lever.cross(row_x), twice_y = lever.cross(row_y);
  m(3, 3) += twice_x.x();
  m(4, 3) += twice_x.y();
  m(5, 3) += twice_x.z();
  m(4, 4) += twice_y.y();
  m(5, 4) += twice_y.z();
  m(5, 5) += lever.x() * row_z.y() - lever.y() * row_z.x();
  normal.gradient.head<3>() += sums.gradient_sum;
  normal.gradient.tail<3>() += lever.cross(sums.gradient_sum);
  normal.chi_square += sums.squares;
}

}  // namespace

bool add_markers(std::span<const WeightedMarker> markers, const Pose& T_camera_tool,
                 const Vector3& mean_m, NormalEquations& normal) noexcept {
  const Matrix3 rotation = T_camera_tool.rotation.toRotationMatrix();
  const Vector3 mean = rotation * mean_m + T_camera_tool.translation;
  for (const WeightedMarker& marker : markers) {
    const Vector3 lever = rotation * (marker.model_m - mean_m);
    const Vector3 point = mean + lever;
    const double along = marker.ray.dot(point);
    if (!(along > k_depth_part_min * marker.range_m)) return false;
    const double inverse = 1 / along;
    const double first = marker.across_first.dot(point) * inverse;
    const double second = marker.across_second.dot(point) * inverse;
    const double range = std::sqrt(point.squaredNorm());
    PointSums sums;
    sums.add(first, (marker.across_first - marker.ray * first) * inverse);
    sums.add(second, (marker.across_second - marker.ray * second) * inverse);
    sums.add((range - marker.range_m) * marker.per_range_sigma,
             point * (marker.per_range_sigma / range));
    add_point(sums, lever, normal);
  }
  return true;
}

}  // namespace glint
