#include "kernels/pose/best_rotation.hpp"

#include <cmath>

namespace glint {
namespace {

// Off-diagonals below this part of the trace are zero to rounding. Treated as such, they also never
// become so small that the processor's slow path for denormal numbers takes over.
constexpr double k_negligible = 1e-20;

// Below this part of its largest possible value the Newton matrix's determinant is rounding alone.
constexpr double k_ambiguous = 1e-9;

struct Eigenvectors {
  double pp, qq, rr;  // the diagonal of what C^T C has become
  double pq, pr, qr;
  Vector3 p, q, r;
};

// Turns columns p and q so that their off-diagonal becomes zero.
void rotate(double& pp, double& qq, double& pq, double& pr, double& qr, Vector3& p, Vector3& q,
            double negligible) {
  const bool zero = !(std::abs(pq) > negligible);
  const double twice = zero ? 0.0 : 2 * pq;
  const double difference = zero ? 1.0 : pp - qq;
  const double inverse = 1 / std::sqrt(difference * difference + twice * twice);
  const double cosine = std::sqrt(0.5 + 0.5 * std::abs(difference) * inverse);
  const double sine = (difference < 0 ? -twice : twice) * inverse / (2 * cosine);
  const double shift = sine / cosine * pq;
  pp += zero ? 0.0 : shift;
  qq -= zero ? 0.0 : shift;
  pq = 0;
  const double turned = cosine * pr + sine * qr;
  qr = cosine * qr - sine * pr;
  pr = turned;
  const Vector3 column = cosine * p + sine * q;
  q = cosine * q - sine * p;
  p = column;
}

Eigenvectors eigenvectors_of_square(const Matrix3& c) {
  Eigenvectors e;
  e.pp = c.col(0).squaredNorm();
  e.qq = c.col(1).squaredNorm();
  e.rr = c.col(2).squaredNorm();
  e.pq = c.col(0).dot(c.col(1));
  e.pr = c.col(0).dot(c.col(2));
  e.qr = c.col(1).dot(c.col(2));
  e.p = Vector3::UnitX();
  e.q = Vector3::UnitY();
  e.r = Vector3::UnitZ();
  const double negligible = k_negligible * (e.pp + e.qq + e.rr);
  for (int sweep = 0; sweep < k_rotation_sweeps; ++sweep) {
    rotate(e.pp, e.qq, e.pq, e.pr, e.qr, e.p, e.q, negligible);
    rotate(e.pp, e.rr, e.pr, e.pq, e.qr, e.p, e.r, negligible);
    rotate(e.qq, e.rr, e.qr, e.pq, e.pr, e.q, e.r, negligible);
  }
  return e;
}

Quaternion newton_step(const Quaternion& rotation, const Matrix3& c) {
  const Matrix3 m = rotation.toRotationMatrix().transpose() * c;
  const Vector3 skew(m(2, 1) - m(1, 2), m(0, 2) - m(2, 0), m(1, 0) - m(0, 1));
  const double trace = m(0, 0) + m(1, 1) + m(2, 2);
  const Matrix3 k = trace * Matrix3::Identity() - 0.5 * (m + m.transpose());
  const Vector3 c0 = k.col(1).cross(k.col(2));
  const Vector3 c1 = k.col(2).cross(k.col(0));
  const Vector3 c2 = k.col(0).cross(k.col(1));
  const double determinant = k.col(0).dot(c0);
  const bool ambiguous = !(determinant > k_ambiguous * trace * trace * trace);
  const double half = ambiguous ? 0.0 : 0.5 / determinant;
  const Quaternion turn(1.0, half * c0.dot(skew), half * c1.dot(skew), half * c2.dot(skew));
  return (rotation * turn).normalized();
}

}  // namespace

Quaternion best_rotation(const Matrix3& c) noexcept {
  const Eigenvectors e = eigenvectors_of_square(c);
  // The two columns with the larger singular values, the largest first: by selection, not by jumps.
  const bool swap_pq = e.pp < e.qq;
  const Vector3 larger = swap_pq ? e.q : e.p;
  const Vector3 smaller = swap_pq ? e.p : e.q;
  const double least = swap_pq ? e.pp : e.qq;
  const Vector3 v0 = larger;
  const Vector3 v1 = least < e.rr ? e.r : smaller;
  const Vector3 b0 = c * v0;
  const Vector3 b1 = c * v1;
  const bool swap = b0.squaredNorm() < b1.squaredNorm();
  const Vector3 first = swap ? b1 : b0;
  const Vector3 second = swap ? b0 : b1;
  const Vector3 v_first = swap ? v1 : v0;
  const Vector3 v_second = swap ? v0 : v1;

  const Vector3 u0 = first / std::sqrt(first.squaredNorm());
  const Vector3 across = second - u0 * u0.dot(second);
  const Vector3 u1 = across / std::sqrt(across.squaredNorm());
  const Matrix3 rotation = u0 * v_first.transpose() + u1 * v_second.transpose() +
                           u0.cross(u1) * v_first.cross(v_second).transpose();
  return newton_step(Quaternion(rotation).normalized(), c);
}

}  // namespace glint
