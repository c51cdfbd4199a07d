// Quaternion compression to 50 bits (smallest three): omits the largest of the four components.
//
// What:     unit quaternion -> index of the largest component, the other three as 16-bit integers.
// Cost:     one square root each way.
// Worst:    two components equally large: omits the first in the order x,y,z,w.
// Accuracy: maximum error 0.0037 deg, see smallest_three_test.cpp.
// Source:   |each of the three| <= 1/sqrt(2), because all four squares sum to 1.
#pragma once

#include <array>
#include <cstdint>

#include "kernels/geometry.hpp"
#include "kernels/nonblocking.hpp"
#include "kernels/wire/can_messages.hpp"

namespace glint {

inline constexpr double k_smallest_three_step =
    can_message("Orientation").signal("Component0").step;

struct SmallestThree {
  std::uint8_t left_out = 3;                // 0..3: x,y,z,w; this component is positive
  std::array<std::int16_t, 3> component{};  // the others in the order x,y,z,w
  bool valid = false;                       // false: the input was not a unit quaternion
};

// Requires a norm within 1e-3 of 1, else `valid` is false; normalises the rest.
[[nodiscard]] SmallestThree to_smallest_three(const Quaternion& rotation) noexcept
    GLINT_NONBLOCKING;

// Returns a unit quaternion for any integers.
[[nodiscard]] Quaternion from_smallest_three(const SmallestThree& packed) noexcept
    GLINT_NONBLOCKING;

}  // namespace glint
