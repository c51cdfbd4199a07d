// SIMD comparison of four distances with the tool's.
//
// What:     for four distances: is |distance - wanted| < gate? The result is all bits of the lane,
//           or one bit.
// Cost:     a few instructions.
// Worst:    data independent.
// Accuracy: exact. The vector types of g++ and clang compare lanes on any machine with SIMD, and
//           one by one on a machine without.
// Source:   none; x86-64 has an instruction that gathers the lanes' highest bits.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>

#include "kernels/lanes.hpp"

namespace glint {

static_assert(std::endian::native == std::endian::little);

inline constexpr int k_lanes = 4;
using FloatLanes = float __attribute__((vector_size(16)));
using BitLanes = std::uint32_t __attribute__((vector_size(16)));

inline FloatLanes lanes_at(const float* numbers) {
  FloatLanes lanes;
  std::memcpy(&lanes, numbers, sizeof lanes);
  return lanes;
}

// Sets all bits of a lane whose distance is near.
inline BitLanes near(FloatLanes distance, FloatLanes wanted, FloatLanes gate) {
  const auto magnitude = reinterpret_cast<BitLanes>(distance - wanted) & 0x7FFFFFFFu;
  return reinterpret_cast<BitLanes>(reinterpret_cast<FloatLanes>(magnitude) < gate);
}

// Gathers one bit per lane into the lowest four bits.
inline std::uint64_t gathered(BitLanes lanes) {
#ifdef GLINT_SSE2
  return static_cast<unsigned>(_mm_movemask_ps(reinterpret_cast<__m128>(lanes)));
#else
  return (lanes[0] & 1u) | (lanes[1] & 2u) | (lanes[2] & 4u) | (lanes[3] & 8u);
#endif
}

}  // namespace glint
