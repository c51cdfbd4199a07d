// Total-least-squares plane through points, from their sums.
//
// What:     the normal is the eigenvector of the points' covariance with the smallest eigenvalue.
// Cost:     data independent: 0.1 us.
// Worst:    collinear or coincident points: returns one of the planes through them;
//           `in_plane_variance_min` is near 0.
// Accuracy: coordinates should be relative to a point nearby: their squares are subtracted.
// Source:   Pearson 1901, Philosophical Magazine 2(11), p. 559.
#pragma once

#include "kernels/isolated_eigenvector.hpp"

namespace glint {

struct PlaneSums {
  double n = 0, x = 0, y = 0, z = 0, xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;

  void add(double px, double py, double pz) {
    n += 1;
    x += px, y += py, z += pz;
    xx += px * px, yy += py * py, zz += pz * pz;
    xy += px * py, xz += px * pz, yz += py * pz;
  }
};

struct FittedPlane {
  Vector3 mean = Vector3::Zero();
  Vector3 normal = Vector3::UnitZ();
  double variance = 0;               // along the normal
  double in_plane_variance_min = 0;  // smaller of the two in-plane variances
};

// Requires n >= 1.
[[nodiscard]] inline FittedPlane fit_plane(const PlaneSums& s) {
  const double part = 1 / s.n;
  FittedPlane out;
  out.mean = Vector3(s.x * part, s.y * part, s.z * part);
  const Vector3& m = out.mean;
  const SymmetricMatrix c{s.xx * part - m.x() * m.x(), s.yy * part - m.y() * m.y(),
                          s.zz * part - m.z() * m.z(), s.xy * part - m.x() * m.y(),
                          s.xz * part - m.x() * m.z(), s.yz * part - m.y() * m.z()};
  const auto times = [&c](const Vector3& v) {
    return Vector3(c.xx * v.x() + c.xy * v.y() + c.xz * v.z(),
                   c.xy * v.x() + c.yy * v.y() + c.yz * v.z(),
                   c.xz * v.x() + c.yz * v.y() + c.zz * v.z());
  };
  const IsolatedEigenvector isolated = isolated_eigenvector(c);
  // The two other eigenvectors are perpendicular to the isolated one.
  const auto [p, q] = orthonormal_basis(isolated.v);
  const Vector3 cp = times(p), cq = times(q);
  const double middle = 0.5 * (p.dot(cp) + q.dot(cq));
  const double half = 0.5 * (p.dot(cp) - q.dot(cq)), mixed = p.dot(cq);
  const double half_difference = std::sqrt(half * half + mixed * mixed);
  if (!isolated.largest) {
    out.normal = isolated.v;
    out.variance = isolated.v.dot(times(isolated.v));
    out.in_plane_variance_min = middle - half_difference;
    return out;
  }
  // Larger column of C - lambda_max I, C the 2x2 covariance in p and q: eigenvector of lambda_min.
  const double along_p = half < 0 ? half_difference - half : mixed;
  const double along_q = half < 0 ? -mixed : -(half_difference + half);
  const double length = std::sqrt(along_p * along_p + along_q * along_q);
  out.normal = length > 0 ? Vector3((along_p * p + along_q * q) / length) : q;
  out.variance = middle - half_difference;
  out.in_plane_variance_min = middle + half_difference;
  return out;
}

}  // namespace glint
