#include "platform/record/crc32.hpp"

#include <array>

namespace glint {
namespace {

using Table = std::array<std::uint32_t, 256>;

constexpr std::array<Table, 8> make_tables() {
  std::array<Table, 8> tables{};
  for (std::uint32_t i = 0; i < 256; ++i) {
    std::uint32_t crc = i;
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1U) != 0 ? 0xEDB88320U : 0U);
    tables[0][i] = crc;
  }
  for (std::size_t k = 1; k < 8; ++k)
    for (std::size_t i = 0; i < 256; ++i) {
      const std::uint32_t before = tables[k - 1][i];
      tables[k][i] = (before >> 8) ^ tables[0][before & 0xFFU];
    }
  return tables;
}

constexpr std::array<Table, 8> k_tables = make_tables();

}  // namespace

std::uint32_t crc32(std::uint32_t crc, std::span<const std::uint8_t> bytes) noexcept {
  crc = ~crc;
  std::size_t i = 0;
  for (; i + 8 <= bytes.size(); i += 8) {
    const std::uint8_t* b = bytes.data() + i;
    crc = k_tables[7][(crc ^ b[0]) & 0xFFU] ^ k_tables[6][((crc >> 8) ^ b[1]) & 0xFFU] ^
          k_tables[5][((crc >> 16) ^ b[2]) & 0xFFU] ^ k_tables[4][((crc >> 24) ^ b[3]) & 0xFFU] ^
          k_tables[3][b[4]] ^ k_tables[2][b[5]] ^ k_tables[1][b[6]] ^ k_tables[0][b[7]];
  }
  for (; i < bytes.size(); ++i) crc = (crc >> 8) ^ k_tables[0][(crc ^ bytes[i]) & 0xFFU];
  return ~crc;
}

}  // namespace glint
