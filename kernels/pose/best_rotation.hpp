// The rotation nearest to a 3x3 matrix: the heart of the rigid fit, with a fixed amount of work.
//
// What:     the R with det R = +1 that makes trace(R^T C) largest. Of C^T C the eigenvector whose
//           eigenvalue lies apart from both others comes from its characteristic equation; one
//           plane rotation of what C carries the directions across it to parts the two others. With
//           v_0, v_1 of the two largest and b_i = C v_i: u_0 = b_0 / |b_0|, u_1 = b_1 made
//           orthogonal to u_0, R = u_0 v_0^T + u_1 v_1^T + (u_0 x u_1)(v_0 x v_1)^T. The cross
//           products are what keeps det R = +1, so that no third singular value is needed and
//           coplanar points are no special case.
// Cost:     the same for every matrix: no iteration but k_eigenvalue_steps on one
//           number (lone_eigenvector.hpp).
// Worst:    every input alike. Where two singular values make the rotation ambiguous (w_1 = -w_2)
//           any of the best rotations is given.
// Accuracy: trace(R^T C) within 1e-14 |C| of the largest over 10^5 random, coplanar, mirrored and
//           nearly ambiguous matrices (best_rotation_test.cpp): only the vector that lies apart is
//           taken from C^T C, so that what squaring costs the small singular values does not count.
// Source:   Kanatani 1994 (C = U W V^T, R = U diag(1, 1, det U V^T) V^T); the eigenvalue that lies
//           apart, and its vector by a cross product: Smith 1961, Communications of the ACM 4, p.
//           168, and Eberly 2014, "A Robust Eigensolver for 3x3 Symmetric Matrices"
//           (lone_eigenvector.hpp).
#pragma once

#include "kernels/geometry.hpp"
#include "kernels/nonblocking.hpp"

namespace glint {

// C finite, and its second singular value not zero: without it the rotation is free about a line.
[[nodiscard]] Quaternion best_rotation(const Matrix3& c) noexcept GLINT_NONBLOCKING;

}  // namespace glint
