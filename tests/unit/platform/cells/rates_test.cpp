// Sections [rates] and [deadlines] of a cell file: what releases the ticks.
#include <gtest/gtest.h>

#include <string>

#include "platform/cells/cell.hpp"
#include "tests/unit/platform/cells/error_message.hpp"

namespace glint {
namespace {

TEST(CellRates, ReleaseTicksByTheClockWhereNothingIsStated) {
  const Cell cell = cell_from_text("[rates]\ntick_hz = 300\n", "cell.toml");
  EXPECT_EQ(cell.tick_release, TickRelease::clock);
  EXPECT_EQ(shortest_tick_gap_of(cell), tick_period_of(cell));
  EXPECT_EQ(highest_tick_hz_of(cell), 300);
}

TEST(CellRates, ShortenTheTicksDeadlineToTheirShortestGap) {
  const std::string text = "[rates]\ntick_hz = 250\ntick_release = \"estimate\"\n";
  const Cell cell = cell_from_text(text, "cell.toml");
  EXPECT_EQ(tick_period_of(cell), milliseconds(4));
  EXPECT_EQ(shortest_tick_gap_of(cell), microseconds(2500));
  EXPECT_EQ(cell.deadlines.tick, microseconds(2500));
  EXPECT_EQ(highest_tick_hz_of(cell), 400);
  EXPECT_EQ(test::error_message_for(text + "[deadlines]\ntick_ms = 2.6\n"),
            "cell.toml:5: deadlines.tick_ms is 2.6; expected a number from 0.001 to 2.5");
}

TEST(CellRates, RefuseAnotherRelease) {
  EXPECT_EQ(
      test::error_message_for("[rates]\ntick_release = \"frame\"\n"),
      "cell.toml:2: rates.tick_release is \"frame\"; expected one of \"clock\", \"estimate\"");
}

}  // namespace
}  // namespace glint
