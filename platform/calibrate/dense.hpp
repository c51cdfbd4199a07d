// Dense linear algebra of the size of a calibration's unknowns, for any size. Eigen's templates for
// it take one to five seconds in every file that instantiates them: here they are compiled once.
#pragma once

#include <Eigen/Core>

namespace glint {

struct SymmetricEigen {
  Eigen::VectorXd values;   // ascending
  Eigen::MatrixXd vectors;  // in columns, of length one
};

[[nodiscard]] SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& matrix);

// How sure a point or a turn is in the direction in which it is least so: the root of the
// covariance's largest eigenvalue, in the root of its unit.
[[nodiscard]] double largest_sigma(const Eigen::MatrixXd& covariance);

[[nodiscard]] Eigen::MatrixXd inverse_of(const Eigen::MatrixXd& matrix);

// R of R * matrix * R = 1, symmetric, for a symmetric positive matrix.
[[nodiscard]] Eigen::MatrixXd inverse_root_of(const Eigen::MatrixXd& matrix);

// Of Moore and Penrose, of a symmetric matrix: also where it has no inverse.
[[nodiscard]] Eigen::MatrixXd pseudo_inverse_of(const Eigen::MatrixXd& matrix);

// x of matrix * x = right, for a symmetric positive matrix.
[[nodiscard]] Eigen::MatrixXd solve_symmetric(const Eigen::MatrixXd& matrix,
                                              const Eigen::MatrixXd& right);

}  // namespace glint
