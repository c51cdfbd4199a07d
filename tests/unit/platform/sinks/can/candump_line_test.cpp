#include "platform/sinks/can/candump_line.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <map>
#include <random>
#include <set>

namespace glint::candump_line_test {
namespace {

CanFrame frame_of(std::uint32_t identifier, std::initializer_list<std::uint8_t> data) {
  CanFrame frame;
  frame.identifier = identifier;
  frame.length = static_cast<std::uint8_t>(data.size());
  std::copy(data.begin(), data.end(), frame.data.begin());
  return frame;
}

std::string text_of(const CanFrame& frame, std::int64_t unix_ns = 1'700'000'000'123'456'789,
                    std::string_view interface = "can0") {
  CandumpLine buffer;
  return std::string(format_candump(frame, unix_ns, interface, buffer));
}

TEST(CandumpLine, IsWrittenAsCandumpWritesIt) {
  EXPECT_EQ(text_of(frame_of(0x1A0, {0x66, 0x35})), "(1700000000.123456) can0 1A0#6635\n");
  EXPECT_EQ(text_of(frame_of(0x7, {})), "(1700000000.123456) can0 007#\n");
  EXPECT_EQ(text_of(frame_of(0x1, {0xFF}), 5'000'000'000), "(0000000005.000000) can0 001#FF\n");
  CanFrame extended = frame_of(0x1FFFFFFF, {1});
  extended.extended = true;
  EXPECT_EQ(text_of(extended), "(1700000000.123456) can0 1FFFFFFF#01\n");
  CanFrame fd = frame_of(0x1A8, {0xAB});
  fd.fd = true;
  EXPECT_EQ(text_of(fd), "(1700000000.123456) can0 1A8##4AB\n");
  fd.bit_rate_switch = true;
  EXPECT_EQ(text_of(fd), "(1700000000.123456) can0 1A8##5AB\n");
}

TEST(CandumpLine, FitsItsBufferAtItsLongest) {
  CanFrame frame;
  frame.identifier = k_can_extended_identifier_max;
  frame.extended = frame.fd = frame.bit_rate_switch = true;
  frame.length = 64;
  frame.data.fill(0xFF);
  const std::string line = text_of(frame, INT64_MAX, "an_interface_name_beyond_the_limit");
  EXPECT_LE(line.size(), k_candump_line_max);
  EXPECT_EQ(line.substr(0, 38), "(9223372036.854775) an_interface_na 1F");
  EXPECT_EQ(text_of(frame, INT64_MIN).substr(0, 19), "(0000000000.000000)");
}

TEST(CandumpLine, ComesBack) {
  constexpr std::uint8_t k_lengths[] = {0, 1, 7, 8, 12, 16, 20, 24, 32, 48, 64};
  std::mt19937 random(41);
  for (int i = 0; i < 3000; ++i) {
    CanFrame frame;
    frame.extended = random() % 2 == 0;
    frame.identifier = static_cast<std::uint32_t>(random()) &
                       (frame.extended ? k_can_extended_identifier_max : k_can_identifier_max);
    frame.fd = random() % 2 == 0;
    frame.bit_rate_switch = frame.fd && random() % 2 == 0;
    frame.length = k_lengths[random() % (frame.fd ? std::size(k_lengths) : 4)];
    for (std::size_t b = 0; b < frame.length; ++b)
      frame.data[b] = static_cast<std::uint8_t>(random());
    const auto record = parse_candump(text_of(frame));
    ASSERT_TRUE(record);
    EXPECT_EQ(record->unix_ns, 1'700'000'000'123'456'000);
    EXPECT_EQ(record->interface, "can0");
    EXPECT_EQ(record->frame.identifier, frame.identifier);
    EXPECT_EQ(record->frame.extended, frame.extended);
    EXPECT_EQ(record->frame.fd, frame.fd);
    EXPECT_EQ(record->frame.bit_rate_switch, frame.bit_rate_switch);
    EXPECT_EQ(record->frame.length, frame.length);
    EXPECT_EQ(record->frame.data, frame.data);
  }
}

TEST(CandumpLine, OfAnOlderKernelIsRead) {
  const auto fast = parse_candump("(1.000000) can0 1A8##1AB");
  const auto slow = parse_candump("(1.000000) can0 1A8##0AB");
  ASSERT_TRUE(fast && slow);
  EXPECT_TRUE(fast->frame.fd && fast->frame.bit_rate_switch);
  EXPECT_TRUE(slow->frame.fd && !slow->frame.bit_rate_switch);
}

TEST(CandumpLine, IsRefusedWhereItIsNone) {
  for (const char* const bad : {"",
                                "(",
                                "()",
                                "(1.0) can0 1A0#",
                                "(1.000000)",
                                "(1.000000) can0",
                                "(1.000000) can0 1A0",
                                "(1.000000) can0 1A#00",
                                "(1.000000) can0 800#00",
                                "(1.000000) can0 20000000#00",
                                "(1.000000) can0 1A0#0",
                                "(1.000000) can0 1A0#0G",
                                "(1.000000) can0 1A0#R",
                                "(1.000000) can0 1A0#000102030405060708",
                                "(1.000000) can0 1A0##",
                                "(1.000000) can0 1A0##1000102030405060708",
                                "(-1.000000) can0 1A0#00",
                                "(1.-00001) can0 1A0#00",
                                "(1.000000)  1A0#00",
                                "(1.000000) \x1B[2J 1A0#00",
                                "(1.000000) a_name_of_16_chr 1A0#00",
                                "(1.00000a) can0 1A0#00",
                                "1.000000 can0 1A0#00",
                                "(99999999999999999999.000000) can0 1A0#00",
                                "(9999999999999.000000) can0 1A0#00"})
    EXPECT_FALSE(parse_candump(bad)) << bad;
  EXPECT_TRUE(parse_candump("(1.000000) can0 1A0#"));
}

// Classic frames have 0 to 8 bytes, FD frames the lengths of ISO 11898-1.
TEST(CandumpLine, HasALengthOfItsKindOfFrame) {
  const std::set<std::size_t> fd{0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 16, 20, 24, 32, 48, 64};
  for (std::size_t length = 0; length <= 70; ++length) {
    const std::string data(2 * length, '5');
    const auto classic = parse_candump("(1.000000) can0 1A0#" + data);
    ASSERT_EQ(classic.has_value(), length <= 8) << length;
    if (classic) {
      EXPECT_EQ(classic->frame.length, length);
    }
    const auto long_frame = parse_candump("(1.000000) can0 1A0##5" + data);
    ASSERT_EQ(long_frame.has_value(), fd.contains(length)) << length;
    if (long_frame) {
      EXPECT_EQ(long_frame->frame.length, length);
    }
    EXPECT_FALSE(parse_candump("(1.000000) can0 1A0##5" + data + "5")) << "half a byte";
  }
}

TEST(CandumpLine, HasAnIdentifierThatItsDigitsHold) {
  for (const auto& [text, identifier] : std::map<std::string, std::uint32_t>{
           {"000", 0}, {"7FF", 0x7FF}, {"00000000", 0}, {"1FFFFFFF", 0x1FFFFFFF}}) {
    const auto record = parse_candump("(1.000000) can0 " + text + "#");
    ASSERT_TRUE(record) << text;
    EXPECT_EQ(record->frame.identifier, identifier);
    EXPECT_EQ(record->frame.extended, text.size() == 8);
  }
  for (const char* bad :
       {"800", "20000000", "FFFFFFFF", "-01", "7F", "07FF", "0007FF", "0000007FF"})
    EXPECT_FALSE(parse_candump("(1.000000) can0 " + std::string(bad) + "#")) << bad;
}

TEST(CandumpLine, HasTheBitRateSwitchInTheLowestFlag) {
  for (unsigned flags = 0; flags < 16; ++flags) {
    const std::string digit(1, "0123456789ABCDEF"[flags]);
    const auto record = parse_candump("(1.000000) can0 1A0##" + digit + "00");
    ASSERT_TRUE(record) << digit;
    EXPECT_TRUE(record->frame.fd);
    EXPECT_EQ(record->frame.bit_rate_switch, flags % 2 == 1) << digit;
  }
  EXPECT_FALSE(parse_candump("(1.000000) can0 1A0##G00"));
}

TEST(CandumpLine, HasATimeFrom1970ToTheLastWholeSecondOfAnInt64) {
  const auto time_of = [](const std::string& time) {
    const auto record = parse_candump("(" + time + ") can0 1A0#00");
    return record ? record->unix_ns : -1;
  };
  EXPECT_EQ(time_of("0.000000"), 0);
  EXPECT_EQ(time_of("0.000001"), 1'000);
  EXPECT_EQ(time_of("0000000012.345678"), 12'345'678'000);
  EXPECT_EQ(time_of("9223372035.999999"), 9'223'372'035'999'999'000);
  EXPECT_EQ(time_of("9223372036.000000"), -1);
  for (const char* bad :
       {"-1.000000", "1.-00001", "1.00000", "1.0000000", ".000000", "1", "1.", "."})
    EXPECT_EQ(time_of(bad), -1) << bad;
  EXPECT_EQ(text_of(frame_of(1, {}), 0), "(0000000000.000000) can0 001#\n");
  EXPECT_EQ(text_of(frame_of(1, {}), 999), "(0000000000.000000) can0 001#\n");
  EXPECT_EQ(text_of(frame_of(1, {}), 1'999'999'999), "(0000000001.999999) can0 001#\n");
}

TEST(CandumpLine, HasItsPartsInTheirPlaces) {
  for (const char* bad :
       {"1.000000) can0 1A0#00", "(1.000000 can0 1A0#00", "(1000000) can.0 1A0#00",
        "(1.000000)can0 1A0#00", "(1.000000) can0  1A0#00", "(1.000000) can0 1A0#00\n\n",
        "(1.000000) can0 1A0#00 "})
    EXPECT_FALSE(parse_candump(bad)) << bad;
  EXPECT_TRUE(parse_candump("(1.000000) can0 1A0#00\n"));
}

// 1 to 15 printable ASCII characters.
TEST(CandumpLine, HasAnInterfaceNameThatLinuxCanHave) {
  for (std::size_t size = 0; size <= 17; ++size) {
    const std::string name(size, 'v');
    const auto record = parse_candump("(1.000000) " + name + " 1A0#");
    ASSERT_EQ(record.has_value(), size >= 1 && size <= 15) << size;
    if (record) {
      EXPECT_EQ(record->interface, name);
    }
  }
  for (int c = 0; c < 256; ++c) {
    const std::string name(1, static_cast<char>(c));
    EXPECT_EQ(parse_candump("(1.000000) v" + name + " 1A0#").has_value(), c > ' ' && c <= '~') << c;
  }
}

TEST(CandumpLine, OfARealLogIsReadAndWrittenUnchanged) {
  const char* const folder = std::getenv("GLINT_TEST_DATA");
  std::ifstream log(std::string(folder == nullptr ? "" : folder) + "/can/icsim_sample-can.log");
  if (!log) GTEST_SKIP() << "icsim_sample-can.log is not here";
  std::string line;
  int count = 0;
  while (std::getline(log, line)) {
    const auto record = parse_candump(line);
    ASSERT_TRUE(record) << line;
    EXPECT_EQ(text_of(record->frame, record->unix_ns, record->interface), line + '\n');
    ++count;
  }
  EXPECT_GT(count, 1000);
}

}  // namespace
}  // namespace glint::candump_line_test
