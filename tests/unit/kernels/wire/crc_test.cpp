#include "kernels/wire/crc.hpp"

#include <gtest/gtest.h>

#include "tests/unit/kernels/wire/hex.hpp"

namespace glint::crc_test {
namespace {

TEST(Crc, GivesTheCatalogueCheckValues) {
  const auto digits = bytes_of_text("123456789");
  EXPECT_EQ(crc8_j1850(digits), 0x4B);
  EXPECT_EQ(crc8_h2f(digits), 0xDF);
  EXPECT_EQ(crc16_ccitt_false(digits), 0x29B1);
}

TEST(Crc, ContinuesWhereAnEarlierCallEnded) {
  const auto digits = bytes_of_text("123456789");
  const std::span<const std::uint8_t> all(digits);
  for (std::size_t cut = 0; cut <= all.size(); ++cut) {
    EXPECT_EQ(crc16_ccitt_step(crc16_ccitt_step(k_crc16_start, all.first(cut)), all.subspan(cut)),
              0x29B1);
    EXPECT_EQ(crc8_h2f_step(crc8_h2f_step(k_crc8_start, all.first(cut)), all.subspan(cut)) ^
                  k_crc8_final_xor,
              0xDF);
  }
}

// Bitwise polynomial division, the definition, against the table.
TEST(Crc, EqualsPolynomialDivision) {
  for (unsigned first = 0; first < 256; ++first) {
    const std::uint8_t bytes[] = {static_cast<std::uint8_t>(first), 0x5A};
    unsigned remainder = 0xFF;
    for (const std::uint8_t byte : bytes) {
      remainder ^= byte;
      for (int bit = 0; bit < 8; ++bit)
        remainder = (remainder & 0x80U) != 0 ? (remainder << 1 ^ 0x11DU) : remainder << 1;
    }
    EXPECT_EQ(crc8_j1850(bytes), remainder ^ 0xFFU);
  }
}

// A message followed by its CRC has remainder zero.
TEST(Crc, OfBytesFollowedByTheirRemainderIsZero) {
  const auto text = bytes_of_text("glint");
  for (std::size_t length = 0; length <= text.size(); ++length) {
    std::vector<std::uint8_t> bytes(text.begin(), text.begin() + static_cast<long>(length));
    const std::uint8_t j1850 = crc8_j1850_step(0x5A, bytes), h2f = crc8_h2f_step(0x5A, bytes);
    const std::uint16_t ccitt = crc16_ccitt_step(0x5A5A, bytes);
    bytes.push_back(j1850);
    EXPECT_EQ(crc8_j1850_step(0x5A, bytes), 0);
    bytes.back() = h2f;
    EXPECT_EQ(crc8_h2f_step(0x5A, bytes), 0);
    bytes.back() = static_cast<std::uint8_t>(ccitt >> 8);
    bytes.push_back(static_cast<std::uint8_t>(ccitt & 0xFFU));
    EXPECT_EQ(crc16_ccitt_step(0x5A5A, bytes), 0);
  }
}

}  // namespace
}  // namespace glint::crc_test
