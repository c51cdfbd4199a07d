#include "kernels/pose/best_rotation.hpp"

#include <algorithm>
#include <cmath>

namespace glint {
namespace {

// Where the eigenvalues of C^T C differ by less than this part of their sum, squared, they are the
// same to rounding, and any axis is as good.
constexpr double k_all_equal = 1e-30;

// From half the determinant h of a matrix with trace 0 and squares that sum to 6: the eigenvalue
// that lies alone, 2 cos(acos(|h|) / 3), with h's sign. It is the only root of x^3 - 3 x = 2 |h|
// beyond x = 1, between sqrt(3) and 2, where the slope is 6 to 9.
double lone_eigenvalue(double h) {
  const double a = std::min(std::abs(h), 1.0);
  // Within 1e-4 (its interpolant at Chebyshev's points); each step nearly squares what is wrong.
  double x = 1.73213266 + a * (0.3306607 + a * (-0.0813824 + a * 0.01863937));
  for (int step = 0; step < k_eigenvalue_steps; ++step) {
    x -= (x * (x * x - 3) - 2 * a) / (3 * (x * x - 1));
  }
  return h < 0 ? -x : x;
}

const Vector3& longer(const Vector3& a, double a_square, const Vector3& b, double b_square) {
  return a_square < b_square ? b : a;
}

// A right singular vector of C whose singular value lies apart from both others, and whether it is
// the largest; else it is the smallest.
struct LoneVector {
  Vector3 v = Vector3::UnitZ();
  bool largest = false;
};
LoneVector lone_vector(const Matrix3& c) {
  const double xx = c.col(0).squaredNorm(), yy = c.col(1).squaredNorm(),
               zz = c.col(2).squaredNorm();
  const double xy = c.col(0).dot(c.col(1)), xz = c.col(0).dot(c.col(2)),
               yz = c.col(1).dot(c.col(2));
  const double mean = (xx + yy + zz) / 3;
  const double dx = xx - mean, dy = yy - mean, dz = zz - mean;
  const double square = (dx * dx + dy * dy + dz * dz + 2 * (xy * xy + xz * xz + yz * yz)) / 6;
  LoneVector out;
  if (!(square > k_all_equal * mean * mean)) return out;
  const double inverse = 1 / std::sqrt(square);
  const double bx = dx * inverse, by = dy * inverse, bz = dz * inverse;
  const double sxy = xy * inverse, sxz = xz * inverse, syz = yz * inverse;
  const double half = 0.5 * (bx * (by * bz - syz * syz) - sxy * (sxy * bz - syz * sxz) +
                             sxz * (sxy * syz - by * sxz));
  const double value = lone_eigenvalue(half);
  out.largest = half >= 0;
  // What is left has rank two, and its rows stand at right angles to the vector.
  const Vector3 r0(bx - value, sxy, sxz), r1(sxy, by - value, syz), r2(sxz, syz, bz - value);
  const Vector3 a = r0.cross(r1), b = r0.cross(r2), d = r1.cross(r2);
  const Vector3& ab = longer(a, a.squaredNorm(), b, b.squaredNorm());
  const Vector3& longest = longer(ab, ab.squaredNorm(), d, d.squaredNorm());
  out.v = longest / std::sqrt(longest.squaredNorm());
  return out;
}

// A right singular vector and C times it.
struct Singular {
  Vector3 v, b;
};

// The two largest, the largest first.
struct LargestTwo {
  Singular first, second;
};
LargestTwo largest_two(const Matrix3& c) {
  const LoneVector lone = lone_vector(c);
  const Vector3& n = lone.v;
  // Two directions across it.
  const double sign = n.z() < 0 ? -1.0 : 1.0;
  const double a = -1 / (sign + n.z());
  const double b = n.x() * n.y() * a;
  const Vector3 p(1 + sign * n.x() * n.x() * a, sign * b, -sign * n.x());
  const Vector3 q(b, sign + n.y() * n.y() * a, -n.y());
  const Vector3 cp = c * p, cq = c * q;
  // One plane rotation makes what C carries them to orthogonal, the longer one first.
  const double apart = cp.squaredNorm() - cq.squaredNorm();
  const double twice = 2 * cp.dot(cq);
  const bool alike = !(std::abs(apart) + std::abs(twice) > 0);
  const double difference = alike ? 1.0 : apart;
  const double inverse = 1 / std::sqrt(difference * difference + twice * twice);
  const double larger = std::sqrt(0.5 + 0.5 * std::abs(difference) * inverse);
  const double smaller = 0.5 * std::abs(twice) * inverse / larger;
  const bool ahead = !(difference < 0);
  const double cosine = ahead ? larger : smaller;
  const double sine = (twice < 0 ? -1.0 : 1.0) * (ahead ? smaller : larger);
  const Singular longer_one{cosine * p + sine * q, cosine * cp + sine * cq};
  const Singular shorter_one{cosine * q - sine * p, cosine * cq - sine * cp};
  if (!lone.largest) return {longer_one, shorter_one};
  return {{n, c * n}, longer_one};
}

}  // namespace

Quaternion best_rotation(const Matrix3& c) noexcept {
  const LargestTwo two = largest_two(c);
  const Vector3 u0 = two.first.b / std::sqrt(two.first.b.squaredNorm());
  const Vector3 across = two.second.b - u0 * u0.dot(two.second.b);
  const Vector3 u1 = across / std::sqrt(across.squaredNorm());
  const Matrix3 rotation = u0 * two.first.v.transpose() + u1 * two.second.v.transpose() +
                           u0.cross(u1) * two.first.v.cross(two.second.v).transpose();
  return Quaternion(rotation).normalized();
}

}  // namespace glint
