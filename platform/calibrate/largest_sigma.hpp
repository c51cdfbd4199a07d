// How sure a point or a turn is in the direction in which it is least so.
#pragma once

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "kernels/geometry.hpp"

namespace glint {

// The root of a covariance's largest eigenvalue, in the root of its unit.
[[nodiscard]] inline double largest_sigma(const Matrix3& covariance) {
  return std::sqrt(
      std::max(0.0, Eigen::SelfAdjointEigenSolver<Matrix3>(covariance).eigenvalues().maxCoeff()));
}

}  // namespace glint
