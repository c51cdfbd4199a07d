// Symmetric positive 6x6 matrices: the normal equations of a pose.
//
// What:     M = L L', the inverse of M, and the x with M x = b.
// Cost:     the factor 50 multiplications, 6 divisions and 6 roots; a solution 42 multiplications.
// Worst:    none is worse than another; a matrix that is not positive is told.
// Accuracy: rounding times the condition of M.
// Source:   Golub and Van Loan 2013, algorithm 4.2.1 and equations (3.1.2), (3.1.4). By hand, for
//           Eigen's way to it leads past a size of cache blocks behind a lock and past a heap.
#pragma once

#include "kernels/geometry.hpp"
#include "kernels/nonblocking.hpp"
#include "kernels/result.hpp"

namespace glint {

using Vector6 = Eigen::Matrix<double, 6, 1>;

struct PoseFactor {
  Matrix6 lower = Matrix6::Zero();             // L below its diagonal ..
  Vector6 inverse_diagonal = Vector6::Zero();  // .. and 1 / what stands on it

  [[nodiscard]] Vector6 solve(const Vector6& right_side) const noexcept GLINT_NONBLOCKING;
  [[nodiscard]] Matrix6 inverse() const noexcept GLINT_NONBLOCKING;
};

// Reads the lower half. Reason::degenerate: not positive beyond rounding, or not
// finite.
[[nodiscard]] Result<PoseFactor> pose_factor(const Matrix6& matrix) noexcept GLINT_NONBLOCKING;

}  // namespace glint
