#include "platform/tools/programming/press_times.hpp"

#include <gtest/gtest.h>

#include "platform/input_error.hpp"

namespace glint {
namespace {

TEST(PressTimes, AreReadAsSecondsFromAndTo) {
  const auto events = press_times("1.0..2.5,3..4.25");
  ASSERT_EQ(events.size(), 4u);
  EXPECT_EQ(events[0], (ButtonEvent{{1'000'000'000}, Button::draw, true}));
  EXPECT_EQ(events[1], (ButtonEvent{{2'500'000'000}, Button::draw, false}));
  EXPECT_EQ(events[3], (ButtonEvent{{4'250'000'000}, Button::draw, false}));
}

TEST(PressTimes, RefuseWhatIsNoRisingPair) {
  for (const char* wrong : {"", "1", "1..", "..2", "2..1", "1..1", "1..2,", "1..3,2..4", "1..nan",
                            "1..inf", "a..b", "1..2x", "1...2", "1..1e300", "1..2;3..4"}) {
    try {
      (void)press_times(wrong);
      ADD_FAILURE() << wrong << " was taken";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("--button"), std::string::npos);
      EXPECT_NE(std::string(error.what()).find("expected FROM..TO"), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace glint
