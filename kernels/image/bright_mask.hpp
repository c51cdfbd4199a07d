// Bit mask of the pixels of a row above a threshold, 64 bytes at a time (SIMD).
//
// What:     bit i of block_mask is pixel i of a whole block; bright_mask: of a block at any x of a
//           row, cut at the end of the row segment.
// Cost:     on x86-64 the same for every block; elsewhere a block without bright pixels costs less,
//           because gathering its bits is the more expensive half. bright_mask may read pixels
//           beyond the segment, never beyond the row.
// Worst:    a bright pixel in every block.
// Accuracy: exact. The vector types of g++ and clang compare lanes on any machine with SIMD, and
//           by words on others.
// Source:   gathering bits by a product: Warren, "Hacker's Delight", 2nd ed., section 7-6.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "kernels/lanes.hpp"

namespace glint {

static_assert(std::endian::native == std::endian::little);

template <class Pixel>
inline constexpr int k_mask_pixels = 64 / static_cast<int>(sizeof(Pixel));

// One bit for each pixel of a block.
template <class Pixel>
using BlockMask = std::conditional_t<sizeof(Pixel) == 1, std::uint64_t, std::uint32_t>;

namespace detail {

#ifdef GLINT_SSE2
inline __m128i sixteen_bytes(const void* pixels) {
  return _mm_loadu_si128(static_cast<const __m128i*>(pixels));
}

// One bit for each byte that is not zero.
inline std::uint64_t nonzero_bytes(__m128i bytes) {
  const int zero = _mm_movemask_epi8(_mm_cmpeq_epi8(bytes, _mm_setzero_si128()));
  return static_cast<unsigned>(zero) ^ 0xFFFFu;
}
#else
template <class Pixel>
struct LanesOf;
template <>
struct LanesOf<std::uint8_t> {
  using Type = std::uint8_t __attribute__((vector_size(16)));
};
template <>
struct LanesOf<std::uint16_t> {
  using Type = std::uint16_t __attribute__((vector_size(16)));
};

// Sets all bits of a lane if its pixel is above the threshold.
template <class Pixel>
typename LanesOf<Pixel>::Type above(const Pixel* pixels, Pixel threshold) {
  using Lanes = typename LanesOf<Pixel>::Type;
  Lanes lanes;
  std::memcpy(&lanes, pixels, sizeof lanes);
  return reinterpret_cast<Lanes>(lanes > (Lanes{} + threshold));
}

template <class Lanes>
bool any_set(const Lanes& lanes) {
  std::uint64_t halves[2];
  std::memcpy(halves, &lanes, sizeof halves);
  return (halves[0] | halves[1]) != 0;
}

// Gathers the lowest bits of the lanes: the product shifts each to its index, without overlap.
template <class Pixel>
std::uint64_t gathered(std::uint64_t lanes) {
  if constexpr (sizeof(Pixel) == 1) {
    return ((lanes & 0x0101010101010101u) * 0x0102040810204080u) >> 56;
  } else {
    return ((lanes & 0x0001000100010001u) * 0x0001000200040008u) >> 48 & 0xF;
  }
}
#endif

// The pixels of a block at x, or further left if the row ends inside the block. A row narrower than
// a block is copied and padded with zeros, which are above no threshold.
template <class Pixel>
struct Block {
  Pixel padded[k_mask_pixels<Pixel>];
  const Pixel* pixels;
  int known = 0;  // pixels of the block before x

  Block(const Pixel* row, int width, int x) : pixels(row) {
    const int last = width - k_mask_pixels<Pixel>;
    if (last >= 0) {
      const int from = std::min(x, last);
      pixels += from;
      known = x - from;
    } else {
      std::memset(padded, 0, sizeof padded);
      std::memcpy(padded, row + x, static_cast<std::size_t>(width - x) * sizeof(Pixel));
      pixels = padded;
    }
  }
};

}  // namespace detail

// Bit i is pixel i of a whole block. SSE2 has no unsigned comparison: one saturating subtraction of
// the threshold leaves a nonzero excess, which narrowing with saturation keeps nonzero.
template <class Pixel>
BlockMask<Pixel> block_mask(const Pixel* pixels, Pixel threshold) {
#ifdef GLINT_SSE2
  if constexpr (sizeof(Pixel) == 1) {
    const __m128i most = _mm_set1_epi8(static_cast<char>(threshold));
    const auto bits = [&](int i) {
      return detail::nonzero_bytes(_mm_subs_epu8(detail::sixteen_bytes(pixels + 16 * i), most));
    };
    return bits(0) | bits(1) << 16 | bits(2) << 32 | bits(3) << 48;
  } else {
    const __m128i most = _mm_set1_epi16(static_cast<short>(threshold));
    const auto bits = [&](int i) {
      const __m128i low = _mm_subs_epu16(detail::sixteen_bytes(pixels + 16 * i), most);
      const __m128i high = _mm_subs_epu16(detail::sixteen_bytes(pixels + 16 * i + 8), most);
      return detail::nonzero_bytes(_mm_packs_epi16(low, high));
    };
    return static_cast<std::uint32_t>(bits(0) | bits(1) << 16);
  }
#else
  constexpr int lanes = 16 / static_cast<int>(sizeof(Pixel));
  typename detail::LanesOf<Pixel>::Type found[4];
  for (int i = 0; i < 4; ++i) found[i] = detail::above(pixels + i * lanes, threshold);
  if (!detail::any_set(found[0] | found[1] | found[2] | found[3])) return 0;
  std::uint64_t words[8];
  std::memcpy(words, found, sizeof words);
  std::uint64_t mask = 0;
  for (int i = 0; i < 8; ++i) mask |= detail::gathered<Pixel>(words[i]) << (i * lanes / 2);
  return static_cast<BlockMask<Pixel>>(mask);
#endif
}

// Bit i is pixel x + i of the row segment that ends before x1.
template <class Pixel>
BlockMask<Pixel> bright_mask(const Pixel* row, int width, int x, int x1, Pixel threshold) {
  const detail::Block<Pixel> at(row, width, x);
  const auto mask = static_cast<BlockMask<Pixel>>(block_mask(at.pixels, threshold) >> at.known);
  const int wanted = x1 - x;
  return wanted < k_mask_pixels<Pixel> ? mask & ((BlockMask<Pixel>{1} << wanted) - 1) : mask;
}

}  // namespace glint
