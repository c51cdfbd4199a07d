// Conversion factors between radians and degrees. Inside Glint every angle is in radians; degrees
// are for user input and output.
#pragma once

#include <numbers>

namespace glint {

inline constexpr double k_radians_per_degree = std::numbers::pi / 180;
inline constexpr double k_degrees_per_radian = 180 / std::numbers::pi;

}  // namespace glint
