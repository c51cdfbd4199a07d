// SIMD vector of two doubles, for loops with independent iterations.
//
// What:     load, store, square root, minimum and maximum. The compiler's vector types provide
//           sums, products, quotients and comparisons per lane.
// Cost:     one instruction each on a machine with double lanes, else two.
// Worst:    data independent.
// Accuracy: each lane has the bits of the scalar operation: IEEE 754 rounds all of these.
// Source:   vector types of g++ and clang; x86-64's SSE2 for the square root.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

#include "kernels/lanes.hpp"

namespace glint {

using TwoDoubles = double __attribute__((vector_size(16)));
// Result of a comparison: all bits of a lane are set, or none.
using TwoMasks = std::int64_t __attribute__((vector_size(16)));

[[nodiscard]] inline TwoDoubles load_two(const double* from) {
  TwoDoubles loaded;
  std::memcpy(&loaded, from, sizeof loaded);
  return loaded;
}

inline void store_two(const TwoDoubles& from, double* to) { std::memcpy(to, &from, sizeof from); }

[[nodiscard]] inline TwoDoubles broadcast_two(double value) { return TwoDoubles{value, value}; }

// Keeps the lanes whose mask is set; the others become 0.
[[nodiscard]] inline TwoDoubles keep_lanes(const TwoMasks& set, const TwoDoubles& value) {
  return reinterpret_cast<TwoDoubles>(set & reinterpret_cast<TwoMasks>(value));
}

[[nodiscard]] inline TwoDoubles minimum(const TwoDoubles& a, const TwoDoubles& b) {
#ifdef GLINT_SSE2
  return reinterpret_cast<TwoDoubles>(
      _mm_min_pd(reinterpret_cast<__m128d>(a), reinterpret_cast<__m128d>(b)));
#else
  return a < b ? a : b;
#endif
}
[[nodiscard]] inline TwoDoubles maximum(const TwoDoubles& a, const TwoDoubles& b) {
#ifdef GLINT_SSE2
  return reinterpret_cast<TwoDoubles>(
      _mm_max_pd(reinterpret_cast<__m128d>(a), reinterpret_cast<__m128d>(b)));
#else
  return a > b ? a : b;
#endif
}

// Requires non-negative lanes.
[[nodiscard]] inline TwoDoubles square_root(const TwoDoubles& of) {
#ifdef GLINT_SSE2
  return reinterpret_cast<TwoDoubles>(_mm_sqrt_pd(reinterpret_cast<__m128d>(of)));
#else
  return TwoDoubles{std::sqrt(of[0]), std::sqrt(of[1])};
#endif
}

}  // namespace glint
