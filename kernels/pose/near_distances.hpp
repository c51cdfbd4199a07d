// Which of four distances are near which of the tool's.
//
// What:     of four distances: is |distance - wanted| < gate? All bits of its lane, or one bit.
// Cost:     a few instructions, the same whatever the distances are.
// Worst:    none is worse than another.
// Accuracy: exact. g++'s and clang's vector types compare lanes on any machine that has lanes, and
//           one by one on one that has none.
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

// All bits of a lane are set where it is near.
inline BitLanes near(FloatLanes distance, FloatLanes wanted, FloatLanes gate) {
  const auto magnitude = reinterpret_cast<BitLanes>(distance - wanted) & 0x7FFFFFFFu;
  return reinterpret_cast<BitLanes>(reinterpret_cast<FloatLanes>(magnitude) < gate);
}

// A bit for each lane, side by side.
inline std::uint64_t gathered(BitLanes lanes) {
#ifdef GLINT_SSE2
  return static_cast<unsigned>(_mm_movemask_ps(reinterpret_cast<__m128>(lanes)));
#else
  return (lanes[0] & 1u) | (lanes[1] & 2u) | (lanes[2] & 4u) | (lanes[3] & 8u);
#endif
}

}  // namespace glint
