// Dense linear algebra of run-time size, for what is not on the run path. Compiled once: Eigen's
// templates take one to eight seconds in each file that instantiates them.
#pragma once

#include <Eigen/Core>

namespace glint {

struct SymmetricEigen {
  Eigen::VectorXd values;   // ascending
  Eigen::MatrixXd vectors;  // columns, unit length
};

[[nodiscard]] SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& matrix);

// Returns the largest standard deviation of a covariance over all directions: the square root of
// its largest eigenvalue, in the root of its unit.
[[nodiscard]] double largest_sigma(const Eigen::MatrixXd& covariance);

[[nodiscard]] Eigen::MatrixXd inverse_of(const Eigen::MatrixXd& matrix);

// Returns the symmetric R with R * matrix * R = 1. Requires a symmetric positive definite matrix.
[[nodiscard]] Eigen::MatrixXd inverse_root_of(const Eigen::MatrixXd& matrix);

// Moore-Penrose pseudoinverse of a symmetric matrix.
[[nodiscard]] Eigen::MatrixXd pseudo_inverse_of(const Eigen::MatrixXd& matrix);

// Returns x of the least |matrix * x - right|. Requires full column rank.
[[nodiscard]] Eigen::VectorXd least_squares(const Eigen::MatrixXd& matrix,
                                            const Eigen::VectorXd& right);

// Returns x of matrix * x = right. Requires a symmetric positive definite matrix.
[[nodiscard]] Eigen::MatrixXd solve_symmetric(const Eigen::MatrixXd& matrix,
                                              const Eigen::MatrixXd& right);

}  // namespace glint
