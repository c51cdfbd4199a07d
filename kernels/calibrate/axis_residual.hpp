// Residual of a spin calibration: a tool rotates about its own axis, whose direction is constant.
//
// What:     R axis_tool - axis_tracker, for unit vectors: 0 for a true spin.
// Cost:     one quaternion product; no loop.
// Worst:    data independent.
// Accuracy: its length is 2 sin(angle / 2) instead of the angle between the two.
// Source:   Siciliano and Khatib 2016, "Springer Handbook of Robotics", section 2.2.4 (the axis of
//           a rotation is the direction that it does not change).
#pragma once

#include "kernels/calibrate/scalar.hpp"

namespace glint {

template <class Scalar>
[[nodiscard]] Vector3Of<Scalar> axis_residual(const Quaternion& measured,
                                              const Vector3Of<Scalar>& axis_tool,
                                              const Vector3Of<Scalar>& axis_tracker) noexcept {
  return rotated<Scalar>(measured.cast<Scalar>(), axis_tool) - axis_tracker;
}

}  // namespace glint
