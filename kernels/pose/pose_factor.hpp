// Cholesky factor, solution and inverse of symmetric positive definite 6x6 matrices (the normal
// equations of a pose).
//
// What:     M = L L', the inverse of M, and the x with M x = b.
// Cost:     the factor 50 multiplications, 6 divisions and 6 roots; a solution 42 multiplications.
// Worst:    data independent; a matrix that is not positive definite returns a Reason.
// Accuracy: rounding times the condition number of M.
// Source:   Golub and Van Loan 2013, algorithm 4.2.1 and equations (3.1.2), (3.1.4). Own code,
//           because Eigen's path reads cache block sizes behind a lock and can allocate.
#pragma once

#include "kernels/geometry.hpp"
#include "kernels/nonblocking.hpp"
#include "kernels/result.hpp"

namespace glint {

using Vector6 = Eigen::Matrix<double, 6, 1>;

struct PoseFactor {
  Matrix6 lower = Matrix6::Zero();             // L below its diagonal
  Vector6 inverse_diagonal = Vector6::Zero();  // 1 / L's diagonal

  [[nodiscard]] Vector6 solve(const Vector6& right_side) const noexcept GLINT_NONBLOCKING;
  [[nodiscard]] Matrix6 inverse() const noexcept GLINT_NONBLOCKING;
};

// Reads the lower triangle. Returns Reason::degenerate if the matrix is not positive definite
// beyond rounding, or not finite.
[[nodiscard]] Result<PoseFactor> pose_factor(const Matrix6& matrix) noexcept GLINT_NONBLOCKING;

}  // namespace glint
