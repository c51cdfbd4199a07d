// Rotation nearest to a 3x3 matrix (orthogonal Procrustes problem), with a fixed amount of work.
//
// What:     the R with det R = +1 that maximises trace(R^T C). The eigenvector of C^T C whose
//           eigenvalue is separated from both others comes from the characteristic equation. One
//           plane rotation makes C times the two perpendicular directions orthogonal, which gives
//           the other two. With v_0, v_1 of the two largest and b_i = C v_i: u_0 = b_0 / |b_0|, u_1
//           = b_1 made orthogonal to u_0, R = u_0 v_0^T + u_1 v_1^T + (u_0 x u_1)(v_0 x v_1)^T. The
//           cross products keep det R = +1, so that no third singular value is needed and coplanar
//           points are no special case.
// Cost:     the same for every matrix: the only iteration is k_eigenvalue_steps on one number
//           (isolated_eigenvector.hpp).
// Worst:    data independent. Where two singular values make the rotation ambiguous (w_1 = -w_2),
//           returns any of the best rotations.
// Accuracy: trace(R^T C) within 1e-14 |C| of the maximum over 10^5 random, coplanar, mirrored and
//           nearly ambiguous matrices (best_rotation_test.cpp). Only the separated vector comes
//           from C^T C, so the digits that the small singular values lose by squaring do not
//           matter.
// Source:   Kanatani 1994 (C = U W V^T, R = U diag(1, 1, det U V^T) V^T); the separated eigenvalue,
//           and its vector by a cross product: Smith 1961, Communications of the ACM 4, p. 168, and
//           Eberly 2014, "A Robust Eigensolver for 3x3 Symmetric Matrices"
//           (isolated_eigenvector.hpp).
#pragma once

#include "kernels/geometry.hpp"
#include "kernels/nonblocking.hpp"

namespace glint {

// Requires a finite C whose second singular value is not zero; otherwise the rotation about a line
// is free.
[[nodiscard]] Quaternion best_rotation(const Matrix3& c) noexcept GLINT_NONBLOCKING;

}  // namespace glint
