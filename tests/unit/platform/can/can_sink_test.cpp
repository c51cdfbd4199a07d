#include "platform/can/can_sink.hpp"

#include <gtest/gtest.h>

#include "platform/input_error.hpp"

namespace glint::can_sink_test {
namespace {

template <class Error>
std::string complaint(const std::string& specification) {
  try {
    const auto sink = open_can_sink(specification);
  } catch (const Error& error) {
    return error.what();
  }
  return "no such error";
}

TEST(CanSink, RefusesWhatItDoesNotKnow) {
  for (const char* const bad : {"", "can0", "log", "log:", "socketcan", "socketcan:", "udp:x"}) {
    const std::string text = complaint<InputError>(bad);
    EXPECT_NE(text.find('"' + std::string(bad) + '"'), std::string::npos) << text;
    EXPECT_NE(text.find("expected"), std::string::npos) << text;
  }
}

TEST(CanSink, NamesTheInterfaceThatIsNotThere) {
  const std::string text = complaint<MissingDevice>("socketcan:nocan7");
  EXPECT_NE(text.find("socketcan:nocan7: no such network interface"), std::string::npos) << text;
  EXPECT_NE(text.find("expected"), std::string::npos) << text;
}

// Loopback is an interface, but none for CAN, with whatever kernel this runs on.
TEST(CanSink, RefusesAnInterfaceThatIsNotForCan) {
  EXPECT_NE(complaint<MissingDevice>("socketcan:lo").find("socketcan:lo"), std::string::npos);
}

TEST(CanSink, RefusesAnInterfaceNameThatLinuxCannotHave) {
  EXPECT_NE(complaint<InputError>("socketcan:a_name_far_too_long").find("at most 15"),
            std::string::npos);
}

TEST(CanSink, NamesTheLogThatCannotBeMade) {
  EXPECT_NE(complaint<InputError>("log:/no/such/folder/can.log").find("/no/such/folder/can.log"),
            std::string::npos);
}

}  // namespace
}  // namespace glint::can_sink_test
