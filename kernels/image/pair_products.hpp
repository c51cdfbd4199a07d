// SIMD dot products of adjacent pairs of eight 16-bit lanes.
//
// What:     the pmaddwd instruction of x86-64; elsewhere the same result from 32-bit lanes.
// Cost:     one instruction on x86-64, eight elsewhere.
// Accuracy: exact, unless all four factors of a pair are -32768: the sum then exceeds 32 bits.
#pragma once

#include <cstdint>

#include "kernels/lanes.hpp"

namespace glint {

using Words = std::int16_t __attribute__((vector_size(16)));
using Sums = std::int32_t __attribute__((vector_size(16)));

// Lane i: a[2 i] b[2 i] + a[2 i + 1] b[2 i + 1].
inline Sums pair_products(Words a, Words b) {
#ifdef GLINT_SSE2
  return reinterpret_cast<Sums>(
      _mm_madd_epi16(reinterpret_cast<__m128i>(a), reinterpret_cast<__m128i>(b)));
#else
  using Bits = std::uint32_t __attribute__((vector_size(16)));
  const auto low = [](Words words) {
    return reinterpret_cast<Sums>(reinterpret_cast<Bits>(words) << 16) >> 16;
  };
  const auto high = [](Words words) { return reinterpret_cast<Sums>(words) >> 16; };
  return low(a) * low(b) + high(a) * high(b);
#endif
}

inline std::int64_t sum_of(Sums lanes) {
  return std::int64_t{lanes[0]} + lanes[1] + lanes[2] + lanes[3];
}

inline std::int64_t sum_of(Words lanes) {
  return sum_of(pair_products(lanes, Words{} + std::int16_t{1}));
}

}  // namespace glint
