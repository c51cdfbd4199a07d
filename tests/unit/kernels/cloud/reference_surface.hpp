// Reference moving least squares in double, with Eigen's solvers and std::exp; tests compare the
// kernel with it.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <vector>

#include "clouds.hpp"
#include "kernels/geometry.hpp"

namespace glint {

struct ReferenceSurface {
  Vector3 point = Vector3::Zero(), normal = Vector3::Zero();
};

inline Vector3 vector_of(const Point& p) {
  return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
}

// Requires at least six neighbours.
inline ReferenceSurface reference_surface(const Point& of, const std::vector<Point>& near,
                                          double radius) {
  Vector3 mean = Vector3::Zero();
  for (const Point& p : near) mean += vector_of(p) / static_cast<double>(near.size());
  Matrix3 covariance = Matrix3::Zero();
  for (const Point& p : near) {
    covariance += (vector_of(p) - mean) * (vector_of(p) - mean).transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Matrix3> solver(covariance);
  const Vector3 n = solver.eigenvectors().col(0), u = solver.eigenvectors().col(1),
                v = solver.eigenvectors().col(2);
  const Vector3 foot = vector_of(of) - n.dot(vector_of(of) - mean) * n;
  Eigen::Matrix<double, 6, 6> a = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 1> b = Eigen::Matrix<double, 6, 1>::Zero();
  for (const Point& p : near) {
    const Vector3 d = (vector_of(p) - foot) / radius;
    const double x = d.dot(u), y = d.dot(v), w = std::exp(-d.squaredNorm());
    Eigen::Matrix<double, 6, 1> row;
    row << 1, x, y, x * x, x * y, y * y;
    a += w * row * row.transpose();
    b += w * d.dot(n) * row;
  }
  const Eigen::Matrix<double, 6, 1> c = a.ldlt().solve(b);
  return {foot + c(0) * radius * n, (n - c(1) * u - c(2) * v).normalized()};
}

}  // namespace glint
