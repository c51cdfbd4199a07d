// Residual of the calibration between two trackers of one body (A X = Y B) with a time offset.
//
// What:     the reference at the sample's time plus the offset, against X pose Y. X transforms the
//           sample's frame to the reference's, Y the reference's body to the tool (its translation
//           is the lever arm). Position and 2 vec(q) of the rotation, each divided by its sigma.
// Cost:     interpolated_pose.hpp and four quaternion products; no loop.
// Worst:    data independent; requires positive sigmas.
// Accuracy: the rotation part is 2 sin(angle / 2) instead of the angle: 1e-5 less at 1 degree.
// Source:   Shah, Eastman and Hong 2012, "An overview of robot-sensor calibration methods", eq. (2)
//           (A X = Y B in absolute form); the offset as in Furgale et al. 2013, eq. (9).
#pragma once

#include "kernels/calibrate/blended_pose.hpp"

namespace glint {

struct AlignSample {
  double seconds = 0;
  Pose pose;                // of the tool, in the frame to be aligned
  MotionSegment reference;  // around seconds + the initial offset
  double position_sigma_m = 1;
  double rotation_sigma_rad = 1;
};

template <class Scalar>
struct AlignResidual {
  Vector3Of<Scalar> position;  // divided by its sigma
  Vector3Of<Scalar> rotation;  // divided by its sigma
};

template <class Scalar>
[[nodiscard]] AlignResidual<Scalar> align_residual(const AlignSample& sample,
                                                   const PoseOf<Scalar>& x, const PoseOf<Scalar>& y,
                                                   const Scalar& offset_s) noexcept {
  const PoseOf<Scalar> reference_pose =
      interpolated_pose(sample.reference, Scalar(sample.seconds) + offset_s);
  const QuaternionOf<Scalar> pose_q = sample.pose.rotation.template cast<Scalar>();
  const Vector3Of<Scalar> pose_t = sample.pose.translation.template cast<Scalar>();
  const Vector3Of<Scalar> body =
      rotated<Scalar>(x.rotation, rotated<Scalar>(pose_q, y.translation) + pose_t) + x.translation;
  const QuaternionOf<Scalar> rotation_error =
      (x.rotation * pose_q * y.rotation).conjugate() * reference_pose.rotation;
  const Scalar two = rotation_error.w() < Scalar(0) ? Scalar(-2) : Scalar(2);
  AlignResidual<Scalar> residual;
  residual.position = (body - reference_pose.translation) / Scalar(sample.position_sigma_m);
  residual.rotation = rotation_error.vec() * (two / Scalar(sample.rotation_sigma_rad));
  return residual;
}

}  // namespace glint
