// Eigenvector of a symmetric 3x3 matrix for its most isolated eigenvalue, without iteration over
// the matrix.
//
// What:     the most isolated eigenvalue from the characteristic cubic by Newton's method, then the
//           longest cross product of two rows of A - lambda I.
// Cost:     data independent: k_eigenvalue_steps Newton steps on one number.
// Worst:    three equal eigenvalues: every vector is an eigenvector; returns z.
// Accuracy: see best_rotation.hpp.
// Source:   Smith 1961, Communications of the ACM 4, p. 168; Eberly 2014, "A Robust Eigensolver for
//           3x3 Symmetric Matrices".
#pragma once

#include <algorithm>
#include <cmath>

#include "kernels/geometry.hpp"

namespace glint {

// Newton steps on the eigenvalue from an error below 1e-4: one step leaves 6e-9, two reach
// rounding.
inline constexpr int k_eigenvalue_steps = 2;

struct SymmetricMatrix {
  double xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;
};

struct IsolatedEigenvector {
  Vector3 v = Vector3::UnitZ();
  bool largest = false;  // its eigenvalue is the largest; else it is the smallest
};

namespace detail {

// Relative limit of the eigenvalues' squared spread. Below it the eigenvalues are equal up to
// rounding and every axis is valid.
inline constexpr double k_spread_relative_min = 1e-30;

// Isolated eigenvalue of a matrix with trace 0 and squared elements that sum to 6, from half its
// determinant h: 2 cos(acos(|h|) / 3) with the sign of h. It is the only root of x^3 - 3 x = 2 |h|
// beyond x = 1; it is between sqrt(3) and 2, where the slope is 6 to 9.
inline double isolated_eigenvalue(double h) {
  const double a = std::min(std::abs(h), 1.0);
  // Cubic interpolant at Chebyshev nodes, error below 1e-4; each Newton step nearly squares it.
  double x = 1.73213266 + a * (0.3306607 + a * (-0.0813824 + a * 0.01863937));
  for (int step = 0; step < k_eigenvalue_steps; ++step) {
    x -= (x * (x * x - 3) - 2 * a) / (3 * (x * x - 1));
  }
  return h < 0 ? -x : x;
}

inline const Vector3& longer(const Vector3& a, double a_square, const Vector3& b, double b_square) {
  return a_square < b_square ? b : a;
}

}  // namespace detail

[[nodiscard]] inline IsolatedEigenvector isolated_eigenvector(const SymmetricMatrix& m) {
  const double mean = (m.xx + m.yy + m.zz) / 3;
  const double dx = m.xx - mean, dy = m.yy - mean, dz = m.zz - mean;
  const double square =
      (dx * dx + dy * dy + dz * dz + 2 * (m.xy * m.xy + m.xz * m.xz + m.yz * m.yz)) / 6;
  IsolatedEigenvector out;
  if (!(square > detail::k_spread_relative_min * mean * mean)) return out;
  const double inverse = 1 / std::sqrt(square);
  const double bx = dx * inverse, by = dy * inverse, bz = dz * inverse;
  const double sxy = m.xy * inverse, sxz = m.xz * inverse, syz = m.yz * inverse;
  const double half = 0.5 * (bx * (by * bz - syz * syz) - sxy * (sxy * bz - syz * sxz) +
                             sxz * (sxy * syz - by * sxz));
  const double value = detail::isolated_eigenvalue(half);
  out.largest = half >= 0;
  // A - lambda I has rank two; its rows are perpendicular to the eigenvector.
  const Vector3 r0(bx - value, sxy, sxz), r1(sxy, by - value, syz), r2(sxz, syz, bz - value);
  const Vector3 a = r0.cross(r1), b = r0.cross(r2), d = r1.cross(r2);
  const Vector3& ab = detail::longer(a, a.squaredNorm(), b, b.squaredNorm());
  const Vector3& longest = detail::longer(ab, ab.squaredNorm(), d, d.squaredNorm());
  out.v = longest / std::sqrt(longest.squaredNorm());
  return out;
}

// Two unit vectors perpendicular to a unit vector n and to each other (orthonormal basis).
// Source: Duff et al. 2017, Journal of Computer Graphics Techniques 6(1).
struct OrthonormalBasis {
  Vector3 p, q;
};
[[nodiscard]] inline OrthonormalBasis orthonormal_basis(const Vector3& n) {
  const double sign = n.z() < 0 ? -1.0 : 1.0;
  const double a = -1 / (sign + n.z());
  const double b = n.x() * n.y() * a;
  return {Vector3(1 + sign * n.x() * n.x() * a, sign * b, -sign * n.x()),
          Vector3(b, sign + n.y() * n.y() * a, -n.y())};
}

}  // namespace glint
