#include "kernels/wire/e2e.hpp"

#include <gtest/gtest.h>

#include "kernels/wire/crc.hpp"
#include "tests/unit/kernels/wire/hex.hpp"

namespace glint::e2e_test {
namespace {

std::string p01(P01Mode mode, unsigned counter) {
  std::vector<std::uint8_t> frame(8);
  protect_p01(frame, 0x123, mode, counter);
  EXPECT_TRUE(check_p01(frame, 0x123, mode));
  return hex_of(frame);
}

TEST(EndToEnd, ProtectsByProfileOneAsPublished) {
  EXPECT_EQ(p01(P01Mode::both, 0), "CC00000000000000");
  EXPECT_EQ(p01(P01Mode::both, 1), "9101000000000000");
  EXPECT_EQ(p01(P01Mode::alternating, 0), "CE00000000000000");
  EXPECT_EQ(p01(P01Mode::alternating, 1), "0201000000000000");
  EXPECT_EQ(p01(P01Mode::low, 0), "CE00000000000000");
  EXPECT_EQ(p01(P01Mode::low, 1), "9301000000000000");
  EXPECT_EQ(p01(P01Mode::nibble, 0), "2A10000000000000");
  EXPECT_EQ(p01(P01Mode::nibble, 1), "7711000000000000");
}

TEST(EndToEnd, ProtectsByProfileTwoAsPublished) {
  std::vector<std::uint8_t> zeros(8);
  protect_p02(zeros, P02DataIds{}, 1);
  EXPECT_EQ(hex_of(zeros), "4501000000000000");
  EXPECT_TRUE(check_p02(zeros, P02DataIds{}));

  P02DataIds list;
  for (std::uint8_t i = 0; i < list.size(); ++i) list[i] = i;
  std::vector<std::uint8_t> rising = bytes_of("0001020304050607");
  protect_p02(rising, list, 2);
  EXPECT_EQ(hex_of(rising), "BC02020304050607");
  EXPECT_TRUE(check_p02(rising, list));
  EXPECT_FALSE(check_p02(rising, P02DataIds{}));
}

TEST(EndToEnd, ProtectsByProfileFiveAsPublished) {
  std::vector<std::uint8_t> frame(8);
  protect_p05(frame, 0x1234, 0);
  EXPECT_EQ(hex_of(frame), "1CCA000000000000");
  EXPECT_TRUE(check_p05(frame, 0x1234));
  protect_p05(frame, 0x1234, 1);
  EXPECT_EQ(hex_of(frame), "CF8D010000000000");
  EXPECT_FALSE(check_p05(frame, 0x1235));
}

TEST(EndToEnd, RejectsEveryFlippedBit) {
  P02DataIds list;
  for (std::uint8_t i = 0; i < list.size(); ++i) list[i] = static_cast<std::uint8_t>(7 * i);
  for (unsigned counter = 0; counter < 15; ++counter) {
    std::vector<std::uint8_t> frame(64, 0xA5);
    for (int bit = 0; bit < 64 * 8; ++bit) {
      const auto byte = static_cast<std::size_t>(bit / 8);
      const auto mask = static_cast<std::uint8_t>(1U << bit % 8);
      protect_p05(frame, 0x1A8, counter);
      frame[byte] ^= mask;
      EXPECT_FALSE(check_p05(frame, 0x1A8)) << bit;
      frame[byte] ^= mask;
      if (bit >= 64) continue;
      const std::span<std::uint8_t> eight = std::span(frame).first(8);
      for (const P01Mode mode : {P01Mode::both, P01Mode::low, P01Mode::nibble}) {
        protect_p01(eight, 0x1A0, mode, counter);
        frame[byte] ^= mask;
        EXPECT_FALSE(check_p01(eight, 0x1A0, mode)) << bit;
        frame[byte] ^= mask;
      }
      protect_p02(eight, list, counter);
      frame[byte] ^= mask;
      EXPECT_FALSE(check_p02(eight, list)) << bit;
      frame[byte] ^= mask;
    }
  }
}

TEST(EndToEnd, NeverSendsCounterFifteenInProfileOneAndRejectsIt) {
  std::vector<std::uint8_t> frame(8);
  protect_p01(frame, 0x1A0, P01Mode::both, 15);
  EXPECT_EQ(frame[1] & 0xF, 0);
  // Exhaustive search for the checksum of a frame whose counter is 15.
  frame[1] = 15;
  for (int crc = 0; crc < 256; ++crc) {
    frame[0] = static_cast<std::uint8_t>(crc);
    EXPECT_FALSE(check_p01(frame, 0x1A0, P01Mode::both));
  }
}

// An 8-bit checksum cannot distinguish all 2048 identifiers. It does distinguish the identifiers of
// one base with the same upper byte, and frames of one kind from different tools.
TEST(EndToEnd, RejectsAnotherToolsFrame) {
  for (std::uint16_t own = 0x1A0; own <= 0x1A4; ++own) {
    std::vector<std::uint8_t> frame(8, 0x11);
    protect_p01(frame, own, P01Mode::both, 3);
    for (std::uint16_t other = 0x100; other < 0x200; ++other)
      EXPECT_EQ(check_p01(frame, other, P01Mode::both), other == own);
    for (int tool = 0; tool < 16; ++tool) {
      const auto other = static_cast<std::uint16_t>(own + 16 * tool);
      EXPECT_EQ(check_p01(frame, other, P01Mode::both), tool == 0) << other;
    }
  }
}

TEST(EndToEnd, LeavesFramesWithoutRoomAlone) {
  std::vector<std::uint8_t> one{0x77};
  protect_p01(one, 1, P01Mode::both, 1);
  protect_p02(one, {}, 1);
  protect_p05(one, 1, 1);
  EXPECT_EQ(one[0], 0x77);
  EXPECT_FALSE(check_p01(one, 1, P01Mode::both));
  EXPECT_FALSE(check_p02(one, {}));
  EXPECT_FALSE(check_p05(one, 1));
}

// AUTOSAR's mode ALT: the identifier's low byte at even counters, its high byte at odd ones.
TEST(EndToEnd, AlternatesTheBytesOfTheIdentifierByTheCounter) {
  constexpr std::uint16_t k_id = 0xA55C;
  for (unsigned counter = 0; counter < k_p01_counters; ++counter) {
    std::vector<std::uint8_t> frame(8, 0x33), expected = frame;
    protect_p01(frame, k_id, P01Mode::alternating, counter);
    EXPECT_TRUE(check_p01(frame, k_id, P01Mode::alternating)) << counter;
    protect_p01(expected, std::uint16_t(counter % 2 == 0 ? k_id : k_id >> 8), P01Mode::low,
                counter);
    EXPECT_EQ(hex_of(frame), hex_of(expected)) << counter;
  }
}

// Bits 4..7 of byte 1 must hold the identifier's nibble, for any checksum.
TEST(EndToEnd, ChecksTheNibbleOfTheIdentifierThatTravels) {
  std::vector<std::uint8_t> frame(8);
  protect_p01(frame, 0x0700, P01Mode::nibble, 4);
  EXPECT_EQ(frame[1], 0x74);
  for (int nibble = 0; nibble < 16; ++nibble) {
    frame[1] = static_cast<std::uint8_t>(nibble << 4 | 4);
    int accepted = 0, accepted_otherwise = 0;
    for (int crc = 0; crc < 256; ++crc) {
      frame[0] = static_cast<std::uint8_t>(crc);
      accepted += check_p01(frame, 0x0700, P01Mode::nibble) ? 1 : 0;
      accepted_otherwise += check_p01(frame, 0x0700, P01Mode::both) ? 1 : 0;
    }
    EXPECT_EQ(accepted, nibble == 7 ? 1 : 0) << nibble;
    EXPECT_EQ(accepted_otherwise, 1) << "the other modes leave it to the data";
  }
}

TEST(EndToEnd, CountsModuloItsCountersAndKeepsTheUpperNibble) {
  for (unsigned counter = 0; counter < 600; ++counter) {
    std::vector<std::uint8_t> frame(8, 0xC6);
    protect_p01(frame, 1, P01Mode::both, counter);
    EXPECT_EQ(frame[1], 0xC0 + counter % 15);
    protect_p02(frame, {}, counter);
    EXPECT_EQ(frame[1], 0xC0 + counter % 16);
    protect_p05(frame, 1, counter);
    EXPECT_EQ(frame[2], counter % 256);
  }
}

// Two bytes hold an 8-bit checksum and a counter; three bytes hold a 16-bit checksum and a counter.
TEST(EndToEnd, ProtectsTheShortestFrameAndRefusesEveryShorterOne) {
  std::vector<std::uint8_t> two(2), three(3);
  protect_p01(two, 0x1A0, P01Mode::both, 3);
  EXPECT_TRUE(check_p01(two, 0x1A0, P01Mode::both));
  protect_p02(two, {}, 3);
  EXPECT_TRUE(check_p02(two, {}));
  protect_p05(three, 0x1A0, 3);
  EXPECT_TRUE(check_p05(three, 0x1A0));
  for (int byte = 0; byte < 256; ++byte) {
    const std::vector<std::uint8_t> one{static_cast<std::uint8_t>(byte)};
    EXPECT_FALSE(check_p01(one, 0x1A0, P01Mode::both)) << byte;
    EXPECT_FALSE(check_p02(one, {})) << byte;
  }
  // The checksum of an empty payload covers the identifier alone.
  const std::uint16_t crc = crc16_ccitt_false(std::vector<std::uint8_t>{0xA0, 0x01});
  std::vector<std::uint8_t> empty{static_cast<std::uint8_t>(crc & 0xFFU),
                                  static_cast<std::uint8_t>(crc >> 8)};
  EXPECT_FALSE(check_p05(empty, 0x1A0));
  const std::vector<std::uint8_t> before = empty;
  protect_p05(empty, 0x1A0, 3);
  EXPECT_EQ(empty, before);
}

}  // namespace
}  // namespace glint::e2e_test
