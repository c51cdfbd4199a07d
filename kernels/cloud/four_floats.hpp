// Four floats that are worked on at once, for loops over points that lie side by side.
//
// What:     arithmetic and comparisons by lane are the language's; here loading, spreading one
//           value, a mask for what lies behind the end of a list, and sums of the lanes.
// Cost:     one to four instructions each where the machine has lanes of floats.
// Worst:    none is worse than another.
// Accuracy: each lane has the bits that a float alone would have; a sum is (0 + 1) + (2 + 3).
// Source:   vector types as g++ and clang have them.
#pragma once

#include <cstdint>
#include <cstring>

namespace glint {

using FourFloats = float __attribute__((vector_size(16)));
// What a comparison gives: all bits of a lane are set, or none.
using FourMasks = std::int32_t __attribute__((vector_size(16)));

// Lists that are read by fours may be read this far behind their end.
inline constexpr int k_four_spare = 3;

[[nodiscard]] inline FourFloats load_four(const float* from) {
  FourFloats loaded;
  std::memcpy(&loaded, from, sizeof loaded);
  return loaded;
}

[[nodiscard]] inline FourFloats all_four(float value) {
  return FourFloats{value, value, value, value};
}

// The first `count` lanes are set; all of them from 4 on.
[[nodiscard]] inline FourMasks first_lanes(int count) {
  return FourMasks{0, 1, 2, 3} < FourMasks{count, count, count, count};
}

[[nodiscard]] inline FourFloats where(const FourMasks& set, const FourFloats& value) {
  return reinterpret_cast<FourFloats>(set & reinterpret_cast<FourMasks>(value));
}

[[nodiscard]] inline double sum_of(const FourFloats& four) {
  return (static_cast<double>(four[0]) + static_cast<double>(four[1])) +
         (static_cast<double>(four[2]) + static_cast<double>(four[3]));
}

// How many lanes are set.
[[nodiscard]] inline int count_of(const FourMasks& set) {
  return -((set[0] + set[1]) + (set[2] + set[3]));
}

}  // namespace glint
