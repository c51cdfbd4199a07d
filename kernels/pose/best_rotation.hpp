// The rotation nearest to a 3x3 matrix: the heart of the rigid fit, with a fixed amount of work.
//
// What:     the R with det R = +1 that makes trace(R^T C) largest. V diagonalises C^T C; with b_i =
//           C v_i of the two largest, u_0 = b_0 / |b_0|, u_1 = b_1 made orthogonal to u_0, R = u_0
//           v_0^T + u_1 v_1^T + (u_0 x u_1)(v_0 x v_1)^T. The cross products are what keeps det R =
//           +1, so that no third singular value is needed and coplanar points are no special case.
//           One Newton step on the rotation then removes what squaring C has cost.
// Cost:     k_rotation_sweeps x 3 plane rotations and one 3x3 solve, the same for every matrix.
// Worst:    every input alike. Where two singular values make the rotation ambiguous (w_1 = -w_2)
//           the Newton step is left out and any of the best rotations is given.
// Accuracy: trace(R^T C) within 1e-14 |C| of the largest over 10^5 random, coplanar and mirrored
//           matrices, within 1e-11 where the rotation is nearly ambiguous (best_rotation_test.cpp).
// Source:   Kanatani 1994 (C = U W V^T, R = U diag(1, 1, det U V^T) V^T); cyclic Jacobi: Golub and
//           Van Loan 2013, Matrix Computations, algorithm 8.5.2; the Newton step: with M = R^T C,
//           (trace(H) I - H) w = vex(M - M^T), H = (M + M^T) / 2, the first order of the condition
//           that M be symmetric.
#pragma once

#include "kernels/geometry.hpp"
#include "kernels/nonblocking.hpp"

namespace glint {

// Cyclic Jacobi converges quadratically: of a 3x3 matrix three sweeps leave so little that the
// Newton step, which squares it once more, reaches rounding. A fourth sweep changes no figure of
// the test, two leave 1e-6.
inline constexpr int k_rotation_sweeps = 3;

// C finite, and its second singular value not zero: without it the rotation is free about a line.
[[nodiscard]] Quaternion best_rotation(const Matrix3& c) noexcept GLINT_NONBLOCKING;

}  // namespace glint
