#include "kernels/pose/best_rotation.hpp"

#include <cmath>

#include "kernels/isolated_eigenvector.hpp"

namespace glint {
namespace {

// Right singular vector of C whose singular value is separated from both others, and whether that
// is the largest; otherwise it is the smallest.
IsolatedEigenvector separated_vector(const Matrix3& c) {
  return isolated_eigenvector({c.col(0).squaredNorm(), c.col(1).squaredNorm(),
                               c.col(2).squaredNorm(), c.col(0).dot(c.col(1)),
                               c.col(0).dot(c.col(2)), c.col(1).dot(c.col(2))});
}

// A right singular vector v and b = C v.
struct Singular {
  Vector3 v, b;
};

// The two with the largest singular values, in descending order.
struct LargestTwo {
  Singular first, second;
};
LargestTwo largest_two(const Matrix3& c) {
  const IsolatedEigenvector lone = separated_vector(c);
  const Vector3& n = lone.v;
  const auto [p, q] = orthonormal_basis(n);
  const Vector3 cp = c * p, cq = c * q;
  // One plane rotation makes their images under C orthogonal; the longer one comes first.
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
