#include "kernels/wire/crc.hpp"

#include <array>

namespace glint {
namespace {

// Table of the remainder of each byte by the polynomial, most significant bit first.
template <class Word>
constexpr std::array<Word, 256> table_of(Word polynomial) {
  constexpr int k_top = 8 * sizeof(Word) - 1;
  std::array<Word, 256> table{};
  for (unsigned byte = 0; byte < 256; ++byte) {
    auto crc = static_cast<Word>(byte << (k_top - 7));
    for (int bit = 0; bit < 8; ++bit) {
      const bool carry = ((crc >> k_top) & 1U) != 0;
      crc = static_cast<Word>(crc << 1);
      if (carry) crc = static_cast<Word>(crc ^ polynomial);
    }
    table[byte] = crc;
  }
  return table;
}

constexpr auto k_j1850_table = table_of<std::uint8_t>(0x1D);
constexpr auto k_h2f_table = table_of<std::uint8_t>(0x2F);
constexpr auto k_ccitt_table = table_of<std::uint16_t>(0x1021);

}  // namespace

std::uint8_t crc8_j1850_step(std::uint8_t crc, std::span<const std::uint8_t> bytes) noexcept {
  for (const std::uint8_t byte : bytes) crc = k_j1850_table[crc ^ byte];
  return crc;
}

std::uint8_t crc8_h2f_step(std::uint8_t crc, std::span<const std::uint8_t> bytes) noexcept {
  for (const std::uint8_t byte : bytes) crc = k_h2f_table[crc ^ byte];
  return crc;
}

std::uint16_t crc16_ccitt_step(std::uint16_t crc, std::span<const std::uint8_t> bytes) noexcept {
  for (const std::uint8_t byte : bytes)
    crc = static_cast<std::uint16_t>((crc << 8) ^ k_ccitt_table[(crc >> 8) ^ byte]);
  return crc;
}

std::uint8_t crc8_j1850(std::span<const std::uint8_t> bytes) noexcept {
  return crc8_j1850_step(k_crc8_start, bytes) ^ k_crc8_final_xor;
}

std::uint8_t crc8_h2f(std::span<const std::uint8_t> bytes) noexcept {
  return crc8_h2f_step(k_crc8_start, bytes) ^ k_crc8_final_xor;
}

std::uint16_t crc16_ccitt_false(std::span<const std::uint8_t> bytes) noexcept {
  return crc16_ccitt_step(k_crc16_start, bytes);
}

}  // namespace glint
