#include "platform/dense.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace glint {
namespace {

constexpr double k_rank_tolerance = 1e-12;  // of the largest eigenvalue

}  // namespace

SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& matrix) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

double largest_sigma(const Eigen::MatrixXd& covariance) {
  return std::sqrt(std::max(0.0, symmetric_eigen(covariance).values.maxCoeff()));
}

Eigen::MatrixXd inverse_of(const Eigen::MatrixXd& matrix) { return matrix.inverse(); }

Eigen::MatrixXd inverse_root_of(const Eigen::MatrixXd& matrix) {
  const SymmetricEigen axes = symmetric_eigen(matrix);
  return axes.vectors * axes.values.cwiseSqrt().cwiseInverse().asDiagonal() *
         axes.vectors.transpose();
}

Eigen::MatrixXd pseudo_inverse_of(const Eigen::MatrixXd& matrix) {
  const SymmetricEigen axes = symmetric_eigen(matrix);
  const double least = axes.values.cwiseAbs().maxCoeff() * k_rank_tolerance;
  Eigen::VectorXd inverted = axes.values;
  for (double& value : inverted) value = std::abs(value) > least ? 1 / value : 0;
  return axes.vectors * inverted.asDiagonal() * axes.vectors.transpose();
}

Eigen::VectorXd least_squares(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right) {
  return matrix.colPivHouseholderQr().solve(right);
}

Eigen::MatrixXd solve_symmetric(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& right) {
  return matrix.ldlt().solve(right);
}

}  // namespace glint
