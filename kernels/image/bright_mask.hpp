// Which pixels of a stretch are brighter than a threshold, 16 bytes at a time.
//
// What:     any_above: is there one at all; bright_mask: bit i tells of pixel i; for_each_bit_run:
//           the runs of set bits.
// Cost:     any_above one pass; bright_mask 64 bytes of pixels.
// Accuracy: exact. g++'s and clang's vector types compare lanes on any machine that has lanes, and
//           by words on one that has none.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>

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

}  // namespace detail

// count >= 0.
template <class Pixel>
bool any_above(const Pixel* pixels, int count, Pixel threshold) {
  constexpr int block = k_mask_pixels<Pixel>;
  constexpr int lanes = block / 4;
  typename detail::LanesOf<Pixel>::Type found[4] = {};  // four, so that none waits for the other
  const auto look = [&](int x) {
    for (int i = 0; i < 4; ++i) found[i] |= detail::above(pixels + x + i * lanes, threshold);
  };
  int x = 0;
  for (; x + block <= count; x += block) look(x);
  bool any = false;
  if (x < count && count >= block) {
    look(count - block);  // the last block overlaps the one before
  } else {
    for (; x < count; ++x) any |= pixels[x] > threshold;
  }
  return any || detail::any_set(found[0] | found[1] | found[2] | found[3]);
}

// count <= k_mask_pixels; the bits from count on are zero.
template <class Pixel>
std::uint64_t bright_mask(const Pixel* pixels, int count, Pixel threshold) {
  Pixel padded[k_mask_pixels<Pixel>];
  if (count < k_mask_pixels<Pixel>) {  // zeros are above no threshold
    std::memset(padded, 0, sizeof padded);
    std::memcpy(padded, pixels, static_cast<std::size_t>(count) * sizeof(Pixel));
    pixels = padded;
  }
  constexpr int lanes = 16 / static_cast<int>(sizeof(Pixel));
  typename detail::LanesOf<Pixel>::Type found[4];
  for (int i = 0; i < 4; ++i) found[i] = detail::above(pixels + i * lanes, threshold);
  if (!detail::any_set(found[0] | found[1] | found[2] | found[3])) return 0;
  std::uint64_t words[8];
  std::memcpy(words, found, sizeof words);
  std::uint64_t mask = 0;
  for (int i = 0; i < 8; ++i) mask |= detail::gathered<Pixel>(words[i]) << (i * lanes / 2);
  return mask;
}

// Calls run(from, to) for each stretch of set bits, lowest first.
template <class Call>
void for_each_bit_run(std::uint64_t mask, Call run) {
  int base = 0;
  while (mask != 0) {
    const int zeros = std::countr_zero(mask);
    mask >>= zeros;
    const int ones = std::countr_one(mask);
    run(base + zeros, base + zeros + ones);
    base += zeros + ones;
    mask = ones == 64 ? 0 : mask >> ones;
  }
}

}  // namespace glint
