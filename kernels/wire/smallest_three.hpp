// A rotation in 50 bits: the largest of the four components is left out, since it follows.
//
// What:     unit quaternion -> index of the largest component, the other three as 16-bit integers.
// Cost:     one square root each way.
// Worst:    two components equally large: the first in the order x,y,z,w is left out.
// Accuracy: 0.0037 deg at worst, see smallest_three_test.cpp.
// Source:   |each of the three| <= 1/sqrt(2), as their squares and the largest one's sum to 1.
#pragma once

#include <array>
#include <cstdint>

#include "kernels/geometry.hpp"
#include "kernels/nonblocking.hpp"

namespace glint {

inline constexpr double k_smallest_three_step = 2.1580187e-5;  // x 32767 = 0.70712 > 1/sqrt(2)

struct SmallestThree {
  std::uint8_t left_out = 3;                // 0..3: x,y,z,w; this component is positive
  std::array<std::int16_t, 3> component{};  // the others in the order x,y,z,w
  bool valid = false;                       // false: the input was not a unit quaternion
};

// Unit within 1e-3; the remaining length error is divided out.
[[nodiscard]] SmallestThree to_smallest_three(const Quaternion& rotation) noexcept
    GLINT_NONBLOCKING;

// Unit, whatever the integers are.
[[nodiscard]] Quaternion from_smallest_three(const SmallestThree& packed) noexcept
    GLINT_NONBLOCKING;

}  // namespace glint
