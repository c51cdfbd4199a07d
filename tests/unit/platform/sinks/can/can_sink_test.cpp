#include "platform/sinks/can/can_sink.hpp"

#include <gtest/gtest.h>

#include "platform/input_error.hpp"

namespace glint::can_sink_test {
namespace {

template <class Error>
std::string error_message(const std::string& specification) {
  try {
    const auto sink = open_can_sink(specification);
  } catch (const Error& error) {
    return error.what();
  }
  return "no such error";
}

TEST(CanSink, RefusesWhatItDoesNotKnow) {
  for (const char* const bad : {"", "can0", "log", "log:", "socketcan", "socketcan:", "udp:x"}) {
    const std::string text = error_message<InputError>(bad);
    EXPECT_EQ(text, "CAN sink: found \"" + std::string(bad) +
                        "\"; expected \"socketcan:IF\" or \"log:FILE\"");
  }
}

TEST(CanSink, NamesTheInterfaceThatIsNotThere) {
  const std::string text = error_message<MissingDevice>("socketcan:nocan7");
  EXPECT_NE(text.find("socketcan:nocan7: no such network interface"), std::string::npos) << text;
  EXPECT_NE(text.find("expected"), std::string::npos) << text;
}

// The loopback interface exists on every kernel but is not a CAN interface.
TEST(CanSink, RefusesAnInterfaceThatIsNotForCan) {
  EXPECT_NE(error_message<MissingDevice>("socketcan:lo").find("socketcan:lo"), std::string::npos);
}

TEST(CanSink, RefusesAnInterfaceNameThatLinuxCannotHave) {
  const std::string longest(15, 'x');
  EXPECT_EQ(error_message<MissingDevice>("socketcan:" + longest),
            "socketcan:" + longest + ": no such network interface; expected one of `ip link`");
  EXPECT_EQ(error_message<InputError>("socketcan:x" + longest),
            "socketcan:x" + longest + ": a name of 16 characters; expected at most 15");
}

TEST(CanSink, HasSentAllWhereNothingWasDroppedAndNothingFailed) {
  for (const std::uint64_t dropped : {0, 2}) {
    for (const std::uint64_t failed : {0, 3}) {
      const CanSinkCounts counts{7, dropped, failed, 0};
      EXPECT_EQ(counts.all_sent(), dropped == 0 && failed == 0);
      EXPECT_EQ(counts.lost(), dropped + failed);
    }
  }
}

TEST(CanSink, NamesTheLogThatCannotBeMade) {
  EXPECT_EQ(error_message<InputError>("log:/no/such/folder/can.log"),
            "/no/such/folder/can.log: cannot be written: No such file or directory; expected a "
            "writable path");
}

}  // namespace
}  // namespace glint::can_sink_test
