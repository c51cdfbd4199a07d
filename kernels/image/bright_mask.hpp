// Which pixels of a row are brighter than a threshold, 64 bytes at a time.
//
// What:     any_above: is there one in these blocks at all; bright_mask: bit i tells of pixel i.
// Cost:     the same for every block, wherever in the row it lies. Both may look at pixels beyond
//           the stretch that is asked for, never beyond the row.
// Worst:    none is worse than another.
// Accuracy: exact. g++'s and clang's vector types compare lanes on any machine that has lanes, and
//           by words on one that has none.
// Source:   gathering bits by a product: Warren, "Hacker's Delight", 2nd ed., section 7-6.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>

#ifdef __SSE2__
#include <emmintrin.h>
#endif

namespace glint {

static_assert(std::endian::native == std::endian::little);

template <class Pixel>
inline constexpr int k_mask_pixels = 64 / static_cast<int>(sizeof(Pixel));

namespace detail {

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

// All bits of a lane are set where the pixel is above the threshold.
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

// The lanes' lowest bits, side by side: the product carries each to its place, and no two meet.
template <class Pixel>
std::uint64_t gathered(std::uint64_t lanes) {
  if constexpr (sizeof(Pixel) == 1) {
    return ((lanes & 0x0101010101010101u) * 0x0102040810204080u) >> 56;
  } else {
    return ((lanes & 0x0001000100010001u) * 0x0001000200040008u) >> 48 & 0xF;
  }
}

// A block's lanes to a bit each. x86-64 has an instruction for it.
template <class Pixel>
std::uint64_t gathered_block(const typename LanesOf<Pixel>::Type (&found)[4]) {
#ifdef __SSE2__
  const auto bits = [](__m128i bytes) {
    return static_cast<std::uint64_t>(static_cast<unsigned>(_mm_movemask_epi8(bytes)));
  };
  const auto lanes = [&](int i) { return reinterpret_cast<__m128i>(found[i]); };
  if constexpr (sizeof(Pixel) == 1) {
    return bits(lanes(0)) | bits(lanes(1)) << 16 | bits(lanes(2)) << 32 | bits(lanes(3)) << 48;
  } else {
    return bits(_mm_packs_epi16(lanes(0), lanes(1))) | bits(_mm_packs_epi16(lanes(2), lanes(3)))
                                                           << 16;
  }
#else
  constexpr int lanes = 16 / static_cast<int>(sizeof(Pixel));
  std::uint64_t words[8];
  std::memcpy(words, found, sizeof words);
  std::uint64_t mask = 0;
  for (int i = 0; i < 8; ++i) mask |= gathered<Pixel>(words[i]) << (i * lanes / 2);
  return mask;
#endif
}

// A block's pixels: those at x, or further left where the row ends sooner. A row narrower than a
// block is copied and padded with zeros, which are above no threshold.
template <class Pixel>
struct Block {
  Pixel padded[k_mask_pixels<Pixel>];
  const Pixel* pixels;
  int known = 0;  // pixels of the block that lie before x

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

// Whether the blocks of the stretch x0 <= x < x1 hold a bright pixel.
template <class Pixel>
bool any_above(const Pixel* row, int width, int x0, int x1, Pixel threshold) {
  constexpr int block = k_mask_pixels<Pixel>;
  constexpr int lanes = block / 4;
  typename detail::LanesOf<Pixel>::Type found[4] = {};  // four, so that none waits for the other
  for (int x = x0; x < x1; x += block) {
    const detail::Block<Pixel> at(row, width, x);
    for (int i = 0; i < 4; ++i) found[i] |= detail::above(at.pixels + i * lanes, threshold);
  }
  return detail::any_set(found[0] | found[1] | found[2] | found[3]);
}

// Bit i is pixel x + i, of the stretch up to x1.
template <class Pixel>
std::uint64_t bright_mask(const Pixel* row, int width, int x, int x1, Pixel threshold) {
  constexpr int lanes = 16 / static_cast<int>(sizeof(Pixel));
  const detail::Block<Pixel> at(row, width, x);
  typename detail::LanesOf<Pixel>::Type found[4];
  for (int i = 0; i < 4; ++i) found[i] = detail::above(at.pixels + i * lanes, threshold);
  if (!detail::any_set(found[0] | found[1] | found[2] | found[3])) return 0;
  std::uint64_t mask = detail::gathered_block<Pixel>(found) >> at.known;
  return x1 - x < 64 ? mask & ((std::uint64_t{1} << (x1 - x)) - 1) : mask;
}

}  // namespace glint
