// Nonlinear refinement of the spin axis.
#pragma once

#include <span>

#include "kernels/geometry.hpp"

namespace glint {

struct SpinAxis {
  Vector3 tool = Vector3::UnitZ();     // unit, tool frame
  Vector3 tracker = Vector3::UnitZ();  // unit, the poses' frame
};

// Least squares of R tool - tracker over the rotations; with a Cauchy loss where sigma_rad > 0.
[[nodiscard]] SpinAxis refined_axis(std::span<const Quaternion> rotations, const SpinAxis& start,
                                    double sigma_rad);

}  // namespace glint
