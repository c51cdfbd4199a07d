// Residual of a pivot calibration: a tool rotates about its static tip.
//
// What:     with a frame's true rotation R, the tool's tip relative to the tool's point `centre`,
//           which was measured at p:  p + R (tip - centre) - post; and the difference of R from the
//           measured rotation, 2 vec(q_measured^-1 q). Both are divided by their sigma.
// Cost:     two quaternion products; no loop.
// Worst:    data independent; requires positive sigmas.
// Accuracy: the rotation part is 2 sin(angle / 2) instead of the angle: 1e-5 less at 1 degree.
// Source:   Yaniv 2015, "Which pivot calibration?", eq. (1) (R_i tip + t_i = post). True rotations
//           as additional unknowns: Fuller 1987, "Measurement Error Models", section 4.1; otherwise
//           noise in R_i biases the tip towards the centre.
#pragma once

#include "kernels/calibrate/scalar.hpp"

namespace glint {

// Measurement of one frame, with standard deviations.
struct PivotSample {
  Quaternion rotation = Quaternion::Identity();  // of the tool in the tracker's frame
  Vector3 centre_m = Vector3::Zero();            // the tool's centre in that frame
  double rotation_sigma_rad = 1;
  double position_sigma_m = 1;
};

template <class Scalar>
struct PivotResidual {
  Vector3Of<Scalar> position;  // divided by its sigma
  Vector3Of<Scalar> rotation;  // divided by its sigma
};

// lever_m: the tip relative to the centre, in the tool's frame.
template <class Scalar>
[[nodiscard]] PivotResidual<Scalar> pivot_residual(const PivotSample& sample,
                                                   const QuaternionOf<Scalar>& rotation,
                                                   const Vector3Of<Scalar>& lever_m,
                                                   const Vector3Of<Scalar>& post_m) noexcept {
  const Vector3Of<Scalar> tip = rotated(rotation, lever_m) + sample.centre_m.cast<Scalar>();
  const QuaternionOf<Scalar> rotation_error = sample.rotation.conjugate().cast<Scalar>() * rotation;
  // q and -q are the same rotation: uses the nearer one.
  const Scalar two = rotation_error.w() < Scalar(0) ? Scalar(-2) : Scalar(2);
  PivotResidual<Scalar> residual;
  residual.position = (tip - post_m) / Scalar(sample.position_sigma_m);
  residual.rotation = rotation_error.vec() * (two / Scalar(sample.rotation_sigma_rad));
  return residual;
}

}  // namespace glint
