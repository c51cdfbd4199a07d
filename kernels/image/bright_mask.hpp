// Which pixels of a short stretch are brighter than a threshold, as bits of a word.
//
// What:     any_above: is there one at all (auto-vectorised); bright_mask: bit i is pixel i; then
//           the runs of set bits.
// Cost:     any_above one pass; bright_mask 64 bytes of pixels in eight words.
// Source:   comparing lanes inside a word by their carries: Lamport, "Multiple byte processing with
//           full-word instructions", CACM 18 (1975), section 3.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>

namespace glint {

static_assert(std::endian::native == std::endian::little);

template <class Pixel>
inline constexpr int k_mask_pixels = 64 / static_cast<int>(sizeof(Pixel));

// The greatest of many small lanes vectorises with any instruction set; an early exit does not.
inline bool any_above(const std::uint8_t* pixels, int count, std::uint8_t threshold) {
  std::uint8_t greatest = 0;
  for (int i = 0; i < count; ++i) greatest = pixels[i] > greatest ? pixels[i] : greatest;
  return greatest > threshold;
}

// SSE2 compares 16-bit lanes as signed numbers only: flip the highest bit on both sides.
inline bool any_above(const std::uint16_t* pixels, int count, std::uint16_t threshold) {
  const auto flipped = static_cast<std::int16_t>(threshold ^ 0x8000);
  std::int16_t found = 0;
  for (int i = 0; i < count; ++i) {
    const auto pixel = static_cast<std::int16_t>(pixels[i] ^ 0x8000);
    found = static_cast<std::int16_t>(found | (pixel > flipped ? -1 : 0));
  }
  return found != 0;
}

namespace detail {

// The highest bit of each lane of `lanes` that is greater than the threshold.
template <class Pixel>
std::uint64_t high_bits_above(std::uint64_t lanes, std::uint64_t threshold) {
  constexpr std::uint64_t ones = sizeof(Pixel) == 1 ? 0x0101010101010101u : 0x0001000100010001u;
  constexpr std::uint64_t half = std::uint64_t{1} << (8 * sizeof(Pixel) - 1);
  constexpr std::uint64_t high = ones * half;
  // The lower bits carry into the highest one exactly when they exceed the threshold's lower bits.
  const std::uint64_t carried = (lanes & ~high) + ones * (half - 1 - (threshold & (half - 1)));
  return (threshold < half ? carried | lanes : carried & lanes) & high;
}

// The lanes' highest bits, side by side.
template <class Pixel>
std::uint64_t gathered(std::uint64_t high_bits) {
  if constexpr (sizeof(Pixel) == 1) return ((high_bits >> 7) * 0x0102040810204080u) >> 56;
  return ((high_bits >> 15) * 0x0001000200040008u) >> 48 & 0xF;
}

}  // namespace detail

// count <= k_mask_pixels; the bits from count on are zero.
template <class Pixel>
std::uint64_t bright_mask(const Pixel* pixels, int count, Pixel threshold) {
  std::uint64_t words[8];
  if (count == k_mask_pixels<Pixel>) {
    std::memcpy(words, pixels, sizeof words);
  } else {  // zeros are above no threshold
    std::memset(words, 0, sizeof words);
    std::memcpy(words, pixels, static_cast<std::size_t>(count) * sizeof(Pixel));
  }
  constexpr int lanes = 8 / static_cast<int>(sizeof(Pixel));
  std::uint64_t mask = 0;
  for (int i = 0; i < 8; ++i) {
    const std::uint64_t bits = detail::high_bits_above<Pixel>(words[i], threshold);
    mask |= detail::gathered<Pixel>(bits) << (i * lanes);
  }
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
