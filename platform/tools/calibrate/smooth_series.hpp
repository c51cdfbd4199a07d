// Smoothing of a pose series by local quadratic least squares (Savitzky-Golay). The derivative by a
// clock offset needs it: over 10 ms, noise exceeds the motion of a hand.
#pragma once

#include <span>
#include <vector>

#include "kernels/motion/interpolate.hpp"

namespace glint {

// Fits a parabola through each pose and up to four neighbours on either side within 50 ms, for
// position and rotation vector. Keeps a pose unchanged if fewer than five samples are near.
// Source: Savitzky and Golay 1964, "Smoothing and differentiation of data"; here for irregular time
// stamps.
[[nodiscard]] std::vector<TimedPose> smooth_series(std::span<const TimedPose> poses);

}  // namespace glint
