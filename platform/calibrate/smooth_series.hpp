// A motion without its noise: what an offset's derivative needs, for between neighbours a hundredth
// of a second apart noise moves more than a hand.
#pragma once

#include <span>
#include <vector>

#include "kernels/motion/interpolate.hpp"

namespace glint {

// Each pose by the parabola through it and up to four neighbours on either side within 50 ms, for
// position and rotation vector; as it is where fewer than five are near.
// Source: Savitzky and Golay 1964, "Smoothing and differentiation of data", for uneven stamps.
[[nodiscard]] std::vector<StampedPose> smooth_series(std::span<const StampedPose> poses);

}  // namespace glint
