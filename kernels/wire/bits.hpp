// Bit fields and byte serialisation of integers, independent of the machine's byte order.
#pragma once

#include <cstdint>
#include <span>

namespace glint {

// The low `width` bits of `value` at bit `at` of a word whose bit 0 is the first byte's lowest
// (Intel order, as a DBC file counts).
[[nodiscard]] constexpr std::uint64_t bits_at(std::uint64_t value, int at, int width) noexcept {
  return (value & (~std::uint64_t{0} >> (64 - width))) << at;
}

[[nodiscard]] constexpr std::uint64_t unsigned_at(std::uint64_t word, int at, int width) noexcept {
  return (word >> at) & (~std::uint64_t{0} >> (64 - width));
}

[[nodiscard]] constexpr std::int64_t signed_at(std::uint64_t word, int at, int width) noexcept {
  return static_cast<std::int64_t>(word << (64 - at - width)) >> (64 - width);
}

// Writes bytes.size() bytes (1..8), lowest first.
constexpr void put_little_endian(std::span<std::uint8_t> bytes, std::uint64_t value) noexcept {
  for (std::uint8_t& byte : bytes) {
    byte = static_cast<std::uint8_t>(value & 0xFFU);
    value >>= 8;
  }
}

[[nodiscard]] constexpr std::uint64_t get_little_endian(
    std::span<const std::uint8_t> bytes) noexcept {
  std::uint64_t value = 0;
  for (std::size_t i = bytes.size(); i-- > 0;) value = value << 8 | bytes[i];
  return value;
}

// Extends the low 32 bits of a count, as a message carries them: returns the count with these bits
// that is nearest to `near`, the newest count before it. Counts are not negative.
[[nodiscard]] constexpr std::uint64_t extended_count(std::uint32_t low,
                                                     std::uint64_t near) noexcept {
  const auto step = static_cast<std::int32_t>(low - static_cast<std::uint32_t>(near));
  const std::uint64_t count = near + static_cast<std::uint64_t>(std::int64_t{step});
  return step < 0 && count > near ? low : count;
}

constexpr void put_big_endian(std::span<std::uint8_t> bytes, std::uint64_t value) noexcept {
  for (std::size_t i = bytes.size(); i-- > 0;) {
    bytes[i] = static_cast<std::uint8_t>(value & 0xFFU);
    value >>= 8;
  }
}

}  // namespace glint
