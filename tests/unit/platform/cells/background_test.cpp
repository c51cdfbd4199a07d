// The section [background] of a cell file.
#include <gtest/gtest.h>

#include <string>

#include "platform/cells/cell.hpp"
#include "tests/unit/platform/cells/complaint.hpp"

namespace glint {
namespace {

using test::complaint_about;

TEST(CellBackground, IsNoneWhereACellSaysNothing) {
  EXPECT_FALSE(default_cell().background);
  const Cell cell = cell_from_text("name = \"plain\"\n", "cell.toml");
  EXPECT_FALSE(cell.background);
  EXPECT_EQ(limits_of(cell).background_steps, k_background_steps_max);
}

TEST(CellBackground, TakesPeriodAndStepsAndGivesThemToTheLimits) {
  const Cell cell = cell_from_text("[background]\nperiod_ms = 12.5\nsteps = 700\n", "cell.toml");
  ASSERT_TRUE(cell.background);
  EXPECT_EQ(cell.background->period, microseconds(12'500));
  EXPECT_EQ(limits_of(cell).background_steps, 700);
  const Cell bare = cell_from_text("[background]\n", "cell.toml");
  ASSERT_TRUE(bare.background);
  EXPECT_EQ(bare.background->period, milliseconds(100));
  EXPECT_EQ(bare.background->steps, k_background_steps_max);
}

TEST(CellBackground, RefusesWhatIsOutOfRangeByItsLine) {
  const struct {
    const char* text;
    const char* said;
  } cases[] = {
      {"period_ms = 0", "cell.toml:2: background.period_ms is 0; expected a number from 1 to 1000"},
      {"period_ms = 1001",
       "cell.toml:2: background.period_ms is 1001; expected a number from 1 to 1000"},
      {"period_ms = \"often\"",
       "cell.toml:2: background.period_ms is \"often\"; expected a number from 1 to 1000"},
      {"steps = 0", "cell.toml:2: background.steps is 0; expected a whole number from 1 to 50000"},
      {"steps = 50001",
       "cell.toml:2: background.steps is 50001; expected a whole number from 1 to 50000"},
      {"step = 1", "cell.toml:2: unknown key background.step; expected one of period_ms, steps"},
  };
  for (const auto& [text, said] : cases) {
    EXPECT_EQ(complaint_about("[background]\n" + std::string(text) + "\n"), said);
  }
}

}  // namespace
}  // namespace glint
