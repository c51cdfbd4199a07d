#include "schedules/bus_load.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

namespace glint {
namespace {

using Bits = std::vector<bool>;

void append(Bits& bits, std::uint64_t value, int width) {
  for (int i = width; i-- > 0;) bits.push_back((value >> i & 1U) != 0);
}

// Stuff bits: after five equal bits the opposite one, which counts for the next run.
int stuffing_of(const Bits& bits) {
  int inserted = 0;
  int run = 0;
  bool last = false;
  for (const bool bit : bits) {
    run = run > 0 && bit == last ? run + 1 : 1;
    last = bit;
    if (run < 5) continue;
    ++inserted;
    last = !bit;
    run = 1;
  }
  return inserted;
}

// CRC-15 of ISO 11898-1, polynomial 4599.
std::uint64_t crc15(const Bits& bits) {
  unsigned crc = 0;
  for (const bool bit : bits) {
    const bool next = bit != ((crc >> 14 & 1U) != 0);
    crc = crc << 1 & 0x7FFFU;
    if (next) crc ^= 0x4599U;
  }
  return crc;
}

// Length of a classic frame with an 11-bit identifier, bit by bit.
int classic_length(std::uint32_t identifier, const std::vector<std::uint8_t>& data) {
  Bits bits;
  append(bits, 0, 1);
  append(bits, identifier, 11);
  append(bits, 0, 3);
  append(bits, data.size(), 4);
  for (const std::uint8_t byte : data) append(bits, byte, 8);
  append(bits, crc15(bits), 15);
  return static_cast<int>(bits.size()) + stuffing_of(bits) + 13;
}

TEST(BusLoad, CountsAtMost135BitsForEightBytes) {
  EXPECT_EQ(worst_case_bits({.data_bytes = 8}).nominal, 135);
  EXPECT_EQ(worst_case_bits({.data_bytes = 8, .extended = true}).nominal, 160);
  EXPECT_EQ(worst_case_bits({.data_bytes = 0}).nominal, 55);
  EXPECT_EQ(worst_case_bits({.data_bytes = 8}).data, 0);
}

TEST(BusLoad, NoClassicFrameIsLongerThanItsBound) {
  std::mt19937 random(1);
  for (int length = 0; length <= 8; ++length) {
    const int bound = worst_case_bits({.data_bytes = length}).nominal;
    for (int i = 0; i < 2000; ++i) {
      std::vector<std::uint8_t> data(static_cast<std::size_t>(length));
      // Mostly the patterns that cause stuffing.
      for (std::uint8_t& byte : data) {
        constexpr std::uint8_t k_patterns[] = {0x00, 0xFF, 0xF0, 0x0F, 0xC3, 0x3C, 0x1E, 0x78};
        byte = k_patterns[random() % std::size(k_patterns)];
      }
      EXPECT_LE(classic_length(random() % 0x800, data), bound);
    }
  }
}

// Worst case of bit stuffing: five equal bits, then four of the other value, and so on.
Bits worst_stuffing(int count) {
  Bits bits;
  bool value = false;
  int left = 5;
  while (static_cast<int>(bits.size()) < count) {
    bits.push_back(value);
    if (--left > 0) continue;
    value = !value;
    left = 4;
  }
  return bits;
}

TEST(BusLoad, CountsBothPhasesOfAnFdFrame) {
  const CanFrameBits bits = worst_case_bits({64, false, true, true});
  const int stuffing = stuffing_of(worst_stuffing(17 + 5 + 512));
  EXPECT_EQ(bits.nominal + bits.data, 17 + 5 + 512 + stuffing + 4 + 21 + 7 + 15);
  EXPECT_EQ(bits.nominal, 17 + 4 + 15);
  const CanFrameBits slow = worst_case_bits({64, false, true, false});
  EXPECT_EQ(slow.nominal, bits.nominal + bits.data);
  EXPECT_EQ(slow.data, 0);
  // 16 bytes still have the short CRC with its six fixed stuff bits, 20 the long one with seven.
  const int step =
      worst_case_bits({20, false, true, true}).data - worst_case_bits({16, false, true, true}).data;
  EXPECT_EQ(step, 32 + 8 + 4 + 1);
}

// Every length and both kinds of identifier; fields as in ISO 11898-1.
TEST(BusLoad, CountsEveryFieldOfFramesOfAnyLengthAndIdentifier) {
  for (const bool extended : {false, true}) {
    const int classic = extended ? 54 : 34, arbitration = extended ? 36 : 17;
    for (const int length : {0, 1, 2, 7, 8}) {
      const int bits = classic + 8 * length;
      EXPECT_EQ(worst_case_bits({length, extended}).nominal,
                bits + stuffing_of(worst_stuffing(bits)) + 13);
    }
    for (const int length : {0, 8, 16, 20, 64}) {
      const int crc = 4 + (length <= 16 ? 17 : 21), fixed = length <= 16 ? 6 : 7;
      const CanFrameBits bits = worst_case_bits({length, extended, true, true});
      const int stuffed = arbitration + 5 + 8 * length;
      EXPECT_EQ(bits.nominal, arbitration + stuffing_of(worst_stuffing(arbitration)) + 15)
          << length;
      EXPECT_EQ(bits.nominal + bits.data,
                stuffed + stuffing_of(worst_stuffing(stuffed)) + crc + fixed + 15)
          << length;
    }
  }
}

TEST(BusLoad, TakesALengthThatNoFrameHasForTheNearest) {
  for (const bool fd : {false, true}) {
    const int most = fd ? 64 : 8;
    for (const int over : {1, 100}) {
      EXPECT_EQ(worst_case_bits({most + over, false, fd}).nominal,
                worst_case_bits({most, false, fd}).nominal);
      EXPECT_EQ(worst_case_bits({-over, false, fd}).nominal,
                worst_case_bits({0, false, fd}).nominal);
    }
    EXPECT_LT(worst_case_bits({most - 1, false, fd}).nominal,
              worst_case_bits({most, false, fd}).nominal);
  }
}

// A second: poses at the tick rate, ten heartbeats of one byte, two time frames of eight bytes.
TEST(BusLoad, AddsUpEveryFrameOfASecond) {
  for (const CanFormat format : {CanFormat::classic, CanFormat::fd}) {
    const bool fd = format == CanFormat::fd;
    const CanBitRates rates{400e3, 1.6e6};
    const double pose_s = fd ? worst_case_seconds({64, false, true, true}, rates)
                             : 5 * worst_case_seconds({8}, rates);
    const CanLoad load = bus_load({3, 50, format}, rates);
    EXPECT_DOUBLE_EQ(load.pose_seconds, pose_s);
    EXPECT_DOUBLE_EQ(load.frames_per_second, (fd ? 1 : 5) * 3 * 50 + 10 + 2);
    EXPECT_NEAR(load.fraction, 3 * 50 * pose_s + (10 * 65 + 2 * 135) / 400e3, 1e-12);
  }
}

TEST(BusLoad, NoFdFrameIsLongerThanItsBound) {
  std::mt19937 random(2);
  for (int i = 0; i < 2000; ++i) {
    Bits bits;
    for (int bit = 0; bit < 17 + 5 + 512;) {
      const bool value = random() % 2 == 0;
      const int run = 3 + static_cast<int>(random() % 3);
      for (int k = 0; k < run && bit < 17 + 5 + 512; ++k, ++bit) bits.push_back(value);
    }
    const CanFrameBits bound = worst_case_bits({64, false, true, true});
    EXPECT_LE(static_cast<int>(bits.size()) + stuffing_of(bits) + 4 + 21 + 7 + 15,
              bound.nominal + bound.data);
  }
}

TEST(BusLoad, TakesSevenPercentAtAHundredHertz) {
  const CanLoad load = bus_load({1, 100, CanFormat::classic}, {1e6, 4e6});
  EXPECT_NEAR(load.fraction, 0.0675 + 0.00065 + 0.00027, 2e-4);
  EXPECT_NEAR(bus_load({1, 45, CanFormat::classic}, {1e6, 4e6}).fraction, 0.031, 0.001);
  EXPECT_NEAR(load.pose_seconds, 675e-6, 1e-9);
  EXPECT_EQ(load.frames_per_second, 512);
}

TEST(BusLoad, TakesAnFdPosesTimeFromBothRates) {
  const CanFrameShape pose{64, false, true, true};
  EXPECT_NEAR(worst_case_seconds(pose, {500e3, 2e6}), 411e-6, 0.5e-6);
  EXPECT_NEAR(worst_case_seconds(pose, {1e6, 5e6}), 171.6e-6, 0.5e-6);
  EXPECT_NEAR(bus_load({1, 100, CanFormat::fd}, {500e3, 2e6}).fraction, 0.042, 0.002);
}

TEST(BusLoad, RefusesSixteenToolsInClassicFrames) {
  const auto complaint = check_bus_load({16, 250, CanFormat::classic}, {1e6, 4e6});
  ASSERT_TRUE(complaint);
  EXPECT_NE(complaint->find("270 %"), std::string::npos) << *complaint;
  EXPECT_NE(complaint->find("16 tools"), std::string::npos) << *complaint;
  EXPECT_FALSE(check_bus_load({16, 250, CanFormat::fd}, {1e6, 5e6}));
  EXPECT_FALSE(check_bus_load({1, 250, CanFormat::classic}, {1e6, 4e6}));
  EXPECT_TRUE(check_bus_load({1, 1000, CanFormat::classic}, {500e3, 4e6}));
}

TEST(BusLoad, StatesWhatIsNeededAndWhatWouldHelp) {
  // 32 poses of 675 bits a second, and 920 bits of the node's own.
  EXPECT_EQ(
      check_bus_load({16, 2, CanFormat::classic}, {10e3, 4e6}).value_or(""),
      "CAN: 16 tools at 2 Hz in classic frames need 225 % of the bus (1126.0 ms of each "
      "tick's 500.0 ms); expected at most 100 %: use fewer tools, a lower tick_hz, a higher bit "
      "rate or FD frames");
  // 36 bits at 25 kbit/s and 678 at 1 Mbit/s take 2.118 ms; the node's own frames 37 ms a second.
  EXPECT_EQ(check_bus_load({1, 500, CanFormat::fd}, {25e3, 1e6}).value_or(""),
            "CAN: 1 tool at 500 Hz in FD frames need 110 % of the bus (2.2 ms of each tick's 2.0 "
            "ms); expected at most 100 %: use fewer tools, a lower tick_hz, a higher bit rate");
}

TEST(BusLoad, RefusesABitRateOfZeroOrLess) {
  const std::string complaint =
      "CAN: a bit rate of 0 or less; expected bits per second, e.g. 1000000";
  for (const double rate : {0.0, -1.0}) {
    EXPECT_EQ(check_bus_load({1, 250, CanFormat::classic}, {rate, 4e6}), complaint);
    EXPECT_EQ(check_bus_load({1, 250, CanFormat::fd}, {rate, 4e6}), complaint);
    EXPECT_EQ(check_bus_load({1, 250, CanFormat::fd}, {1e6, rate}), complaint);
    EXPECT_FALSE(check_bus_load({1, 250, CanFormat::classic}, {1e6, rate}));
  }
  // Any other value is a valid rate, even if too low.
  EXPECT_NE(check_bus_load({1, 250, CanFormat::classic}, {0.5, 4e6}), complaint);
  EXPECT_NE(check_bus_load({1, 250, CanFormat::fd}, {1e6, 0.5}), complaint);
}

}  // namespace
}  // namespace glint
