// Normal equations of a small rigid motion of a model (Gauss-Newton), accumulated in a fixed order.
//
// What:     for residuals r with the gradient g at a point p: matrix = sum w J' J, slope = sum w J'
//           r, with J = [g', ((p - m) x g)']: a translation, and a rotation about the centroid m.
// Cost:     28 multiplications a residual.
// Worst:    data independent.
// Accuracy: sums of doubles in the order of the calls; equal bits on any machine.
// Source:   Gauss-Newton's equations, e.g. Nocedal and Wright 2006, eq. (10.23); Chen and Medioni
//           1992 for residuals along normals.
#pragma once

#include "kernels/geometry.hpp"
#include "kernels/nonblocking.hpp"
#include "kernels/pose/pose_factor.hpp"

namespace glint {

struct AlignmentSums {
  Matrix6 matrix = Matrix6::Zero();  // lower triangle
  Vector6 slope = Vector6::Zero();
  double squares = 0;  // sum w r^2
  int count = 0;

  void add(const Vector3& lever, const Vector3& gradient, double residual, double weight) noexcept;
};

struct AlignmentStep {
  Vector3 translation = Vector3::Zero();  // metres
  Vector3 rotation = Vector3::Zero();     // radians about the centroid
};

// Least-squares motion. Reason::degenerate: the residuals do not determine all six degrees of
// freedom.
[[nodiscard]] Result<AlignmentStep> solve(const AlignmentSums& sums) noexcept GLINT_NONBLOCKING;

// Translates T and rotates it about the point `centroid`.
[[nodiscard]] Pose moved(const Pose& T, const AlignmentStep& step,
                         const Vector3& centroid) noexcept GLINT_NONBLOCKING;

inline void AlignmentSums::add(const Vector3& lever, const Vector3& gradient, double residual,
                               double weight) noexcept {
  const Vector3 moment = lever.cross(gradient);
  const double row[6] = {gradient.x(), gradient.y(), gradient.z(),
                         moment.x(),   moment.y(),   moment.z()};
  for (int c = 0; c < 6; ++c) {
    const double weighted = weight * row[c];
    slope(c) += weighted * residual;
    for (int r = c; r < 6; ++r) matrix(r, c) += weighted * row[r];
  }
  squares += weight * residual * residual;
  ++count;
}

}  // namespace glint
