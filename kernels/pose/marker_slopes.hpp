// Sensitivity of the weighted fit to the errors of one marker.
//
// What:     columns h = -J' df/dc of the marker's three residuals f, J their derivatives by the
//           pose (normal_equations.hpp), for unit errors c; an error dc moves the pose by N^-1 h
//           dc, N = sum J' J.
// Cost:     seven 6-vectors of two or three products each.
// Worst:    data independent.
// Accuracy: first order in the errors.
// Source:   systematic_covariance.hpp.
#pragma once

#include <cmath>

#include "kernels/geometry.hpp"
#include "kernels/pose/local_rays.hpp"
#include "kernels/pose/pose_factor.hpp"
#include "kernels/pose/weighted_marker.hpp"

namespace glint {

struct MarkerSensitivity {
  Vector6 by_range;                         // error of the measured range, 1 m
  Vector6 by_pixel_x, by_pixel_y;           // error of the measured centroid, 1 px
  Vector6 by_focal;                         // error of the focal length, as a ratio
  Eigen::Matrix<double, 6, 3> by_position;  // error of its position in the tool, 1 m, camera's axes
};

// point: the marker's position by the pose, camera frame; lever: from the markers' mean to it.
[[nodiscard]] inline MarkerSensitivity marker_sensitivity(const WeightedMarker& marker,
                                                          const LocalRays& rays,
                                                          const Vector3& point,
                                                          const Vector3& lever) {
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
  const auto turned = [&](const Vector3& turn) -> Vector6 {
    return rows[0] * marker.across_first.dot(turn) + rows[1] * marker.across_second.dot(turn);
  };
  MarkerSensitivity slopes;
  slopes.by_range = rows[2] * marker.per_range_sigma;
  slopes.by_pixel_x = turned(rays.along_x);
  slopes.by_pixel_y = turned(rays.along_y);
  slopes.by_focal = turned(rays.outward);
  for (int axis = 0; axis < 3; ++axis) {
    slopes.by_position.col(axis) =
        rows[0] * gradients[0](axis) + rows[1] * gradients[1](axis) + rows[2] * gradients[2](axis);
  }
  return slopes;
}

}  // namespace glint
