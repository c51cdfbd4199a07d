// SIMD vector of four floats, for loops over points stored in columns.
//
// What:     load, broadcast, a mask for the end of an array, and sums of the lanes. The compiler's
//           vector types provide arithmetic and comparisons per lane.
// Cost:     one to four instructions each on a machine with float lanes.
// Worst:    data independent.
// Accuracy: each lane has the bits of the scalar operation; a sum is (0 + 1) + (2 + 3).
// Source:   vector types of g++ and clang.
#pragma once

#include <cstdint>
#include <cstring>

namespace glint {

using FourFloats = float __attribute__((vector_size(16)));
// Result of a comparison: all bits of a lane are set, or none.
using FourMasks = std::int32_t __attribute__((vector_size(16)));

// Arrays read four at a time are read up to this many elements beyond their end.
inline constexpr int k_four_padding = 3;

[[nodiscard]] inline FourFloats load_four(const float* from) {
  FourFloats loaded;
  std::memcpy(&loaded, from, sizeof loaded);
  return loaded;
}

[[nodiscard]] inline FourFloats broadcast_four(float value) {
  return FourFloats{value, value, value, value};
}

// Sets the first `count` lanes; all of them from 4 on.
[[nodiscard]] inline FourMasks first_lanes(int count) {
  return FourMasks{0, 1, 2, 3} < FourMasks{count, count, count, count};
}

[[nodiscard]] inline FourFloats keep_lanes(const FourMasks& set, const FourFloats& value) {
  return reinterpret_cast<FourFloats>(set & reinterpret_cast<FourMasks>(value));
}

[[nodiscard]] inline double sum_of(const FourFloats& four) {
  return (static_cast<double>(four[0]) + static_cast<double>(four[1])) +
         (static_cast<double>(four[2]) + static_cast<double>(four[3]));
}

// Number of set lanes.
[[nodiscard]] inline int count_of(const FourMasks& set) {
  return -((set[0] + set[1]) + (set[2] + set[3]));
}

}  // namespace glint
