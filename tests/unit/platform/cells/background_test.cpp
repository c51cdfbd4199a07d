// Section [background] of a cell file.
#include <gtest/gtest.h>

#include <string>

#include "platform/cells/cell.hpp"
#include "tests/unit/platform/cells/error_message.hpp"

namespace glint {
namespace {

using test::error_message_for;

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
  EXPECT_EQ(bare.background->period, milliseconds(10));
  EXPECT_EQ(bare.background->steps, k_background_steps_max);
}

TEST(CellBackground, RefusesWhatIsOutOfRangeByItsLine) {
  const struct {
    const char* text;
    const char* error_message;
  } cases[] = {
      {"period_ms = 0", "cell.toml:2: background.period_ms is 0; expected a number from 1 to 1000"},
      {"period_ms = 1001",
       "cell.toml:2: background.period_ms is 1001; expected a number from 1 to 1000"},
      {"period_ms = \"often\"",
       "cell.toml:2: background.period_ms is \"often\"; expected a number from 1 to 1000"},
      {"steps = 0", "cell.toml:2: background.steps is 0; expected a whole number from 1 to 50000"},
      {"steps = 50001",
       "cell.toml:2: background.steps is 50001; expected a whole number from 1 to 50000"},
      {"step = 1",
       "cell.toml:2: unknown key background.step; did you mean steps?; expected one of period_ms, "
       "steps"},
  };
  for (const auto& [text, error_message] : cases) {
    EXPECT_EQ(error_message_for("[background]\n" + std::string(text) + "\n"), error_message);
  }
}

TEST(CellMapping, HasABackgroundAndSettingsOfItsOwn) {
  EXPECT_FALSE(default_cell().mapping);
  const Cell cell = cell_from_text(
      "[mapping]\nsource = \"pictures\"\nperiod_ms = 40\npictures_a_map = 3\nstride = 2\n"
      "voxel_mm = 20\nvoxels_max = 5000\njoints_lost_after_ms = 300\n",
      "there/cell.toml");
  ASSERT_TRUE(cell.mapping && cell.background);
  EXPECT_EQ(cell.mapping->source, "there/pictures");
  EXPECT_EQ(cell.mapping->period, milliseconds(40));
  EXPECT_EQ(cell.mapping->images_per_map, 3);
  EXPECT_EQ(cell.mapping->stride, 2);
  EXPECT_DOUBLE_EQ(cell.mapping->voxel_m, 0.02);
  EXPECT_EQ(cell.mapping->voxels_max, 5000);
  EXPECT_EQ(cell.mapping->joints_lost_after, milliseconds(300));
  EXPECT_EQ(cell.background->period, milliseconds(10));
}

TEST(CellMapping, RefusesWhatIsMissingOrOutOfRangeByItsLine) {
  EXPECT_EQ(error_message_for("[mapping]\nstride = 1\n"),
            "cell.toml:1: [mapping] has no source; expected source = \"FOLDER\" of depth images "
            "with poses");
  const std::string source = "[mapping]\nsource = \"f\"\n";
  EXPECT_EQ(error_message_for(source + "stride = 0\n"),
            "cell.toml:3: mapping.stride is 0; expected a whole number from 1 to 64");
  EXPECT_EQ(error_message_for(source + "voxel_mm = 0\n"),
            "cell.toml:3: mapping.voxel_mm is 0; expected a number from 1 to 1000");
  EXPECT_EQ(error_message_for(source + "joints_lost_after_ms = 0\n"),
            "cell.toml:3: mapping.joints_lost_after_ms is 0; expected a number from 1 to 60000");
  EXPECT_NE(error_message_for(source + "folder = 0\n").find("unknown key mapping.folder"),
            std::string::npos);
}

}  // namespace
}  // namespace glint
