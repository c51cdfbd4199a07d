// What is left when a tool turns about its tip, which stands still.
//
// What:     with a frame's true rotation R, the tool's tip seen from the point `centre` of the tool
//           that was measured at p:  p + R (tip - centre) - post; and by how much R is off the
//           measured rotation, 2 vec(q_measured^-1 q). Both are divided by their sigma.
// Cost:     two quaternion products; no loop.
// Worst:    every input alike; sigmas must be positive.
// Accuracy: the rotation's part is 2 sin(angle / 2) instead of the angle: 1e-5 less at 1 degree.
// Source:   Yaniv 2015, "Which pivot calibration?", eq. (1) (R_i tip + t_i = post); true rotations
//           as unknowns beside it: Fuller 1987, "Measurement Error Models", section 4.1, because
//           noise in R_i would otherwise draw the tip towards the centre.
#pragma once

#include "kernels/calibrate/scalar.hpp"

namespace glint {

// What was measured in one frame, and how sure it is.
struct PivotSample {
  Quaternion rotation = Quaternion::Identity();  // of the tool in the tracker's frame
  Vector3 centre_m = Vector3::Zero();            // where the tool's centre is in that frame
  double rotation_sigma_rad = 1;
  double position_sigma_m = 1;
};

template <class Scalar>
struct PivotResidual {
  Vector3Of<Scalar> position;  // in sigmas
  Vector3Of<Scalar> rotation;  // in sigmas
};

// lever_m: the tip seen from the centre, along the tool's axes.
template <class Scalar>
[[nodiscard]] PivotResidual<Scalar> pivot_residual(const PivotSample& sample,
                                                   const QuaternionOf<Scalar>& rotation,
                                                   const Vector3Of<Scalar>& lever_m,
                                                   const Vector3Of<Scalar>& post_m) noexcept {
  const Vector3Of<Scalar> tip = rotated(rotation, lever_m) + sample.centre_m.cast<Scalar>();
  const QuaternionOf<Scalar> off = sample.rotation.conjugate().cast<Scalar>() * rotation;
  // q and -q are one rotation: the nearer of the two is meant.
  const Scalar two = off.w() < Scalar(0) ? Scalar(-2) : Scalar(2);
  PivotResidual<Scalar> residual;
  residual.position = (tip - post_m) / Scalar(sample.position_sigma_m);
  residual.rotation = off.vec() * (two / Scalar(sample.rotation_sigma_rad));
  return residual;
}

}  // namespace glint
