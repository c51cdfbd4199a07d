#include "kernels/wire/e2e.hpp"

#include <gtest/gtest.h>

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
  // The checksum of a frame whose counter is 15, found by trying all of them.
  frame[1] = 15;
  for (int crc = 0; crc < 256; ++crc) {
    frame[0] = static_cast<std::uint8_t>(crc);
    EXPECT_FALSE(check_p01(frame, 0x1A0, P01Mode::both));
  }
}

// An 8-bit checksum cannot tell 2048 identifiers apart, but it does tell apart all that one base
// gives to tools and frames with the same upper byte, and the tools' own frames of one kind.
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

}  // namespace
}  // namespace glint::e2e_test
