// Residual of a tool calibration: a measured marker against the tool's marker; tool and pose are
// unknown (bundle adjustment).
//
// What:     (R marker + t - measured) / sigma.
// Cost:     one quaternion product; no loop.
// Worst:    data independent; requires positive sigma.
// Accuracy: to rounding.
// Source:   Triggs et al. 2000, "Bundle adjustment: a modern synthesis", section 2 (structure and
//           poses at once), for points measured in three dimensions.
#pragma once

#include "kernels/calibrate/scalar.hpp"

namespace glint {

template <class Scalar>
[[nodiscard]] Vector3Of<Scalar> marker_residual(const Vector3& measured_m, double sigma_m,
                                                const QuaternionOf<Scalar>& rotation,
                                                const Vector3Of<Scalar>& translation_m,
                                                const Vector3Of<Scalar>& marker_m) noexcept {
  return (rotated(rotation, marker_m) + translation_m - measured_m.cast<Scalar>()) /
         Scalar(sigma_m);
}

}  // namespace glint
