// Section [budget] of a cell file, and the derived limits.
#include <gtest/gtest.h>

#include <string>

#include "platform/cells/cell.hpp"
#include "tests/unit/platform/cells/error_message.hpp"

namespace glint {
namespace {

using test::error_message_for;

TEST(CellBudget, FollowsTheCellsToolsAndCameraWhereNothingIsSaid) {
  const Limits limits = limits_of(cell_from_text("name = \"plain\"\n", "cell.toml"));
  EXPECT_EQ(limits.tools, 1);
  EXPECT_EQ(limits.markers_per_tool, 5);  // the pen has five
  EXPECT_EQ(limits.blobs, 64);
  EXPECT_EQ(limits.width, 512);
  EXPECT_EQ(limits.lens_steps, 0);  // no lens search without a ray table
  EXPECT_EQ(limits.ray_steps, 6);   // iterations of the AHAT lens, plus one
  const Limits built_in = limits_of(default_cell());
  EXPECT_EQ(built_in.search_steps, limits.search_steps);
  EXPECT_EQ(built_in.runs_per_band, limits.runs_per_band);
}

TEST(CellBudget, TakesTheProblemThatACellStates) {
  const Cell cell = cell_from_text(
      "[budget]\ntools = 5\nblobs = 100\nruns_per_band = 300\n"
      "search_steps = 500\n",
      "cell.toml");
  const Limits limits = limits_of(cell);
  EXPECT_EQ(limits.tools, 5);
  EXPECT_EQ(limits.blobs, 100);
  EXPECT_EQ(limits.runs_per_band, 300);
  EXPECT_EQ(limits.search_steps, 500);
}

TEST(CellBudget, RefusesMoreThanTheCodeCoversWithTheNearestThatFits) {
  EXPECT_EQ(error_message_for("[budget]\ntools = 17\n"),
            "cell.toml:2: budget.tools is 17; expected a whole number from 1 to 16");
  EXPECT_EQ(error_message_for("[budget]\n\nblobs = 300\n"),
            "cell.toml:3: budget.blobs is 300; expected a whole number from 8 to 256");
  EXPECT_EQ(
      error_message_for("[budget]\ntool = 1\n").rfind("cell.toml:2: unknown key budget.tool", 0),
      0u);
}

TEST(CellBudget, RefusesALoopMaximumThatIsNoneWithTheRangeThatFits) {
  const struct {
    const char* key;
    int least, most;
  } ranges[] = {{"tools", 1, k_tools_max},
                {"blobs", 8, k_blobs_max},
                {"runs_per_band", 64, k_runs_per_band_max},
                {"search_steps", 64, k_search_steps_max}};
  for (const auto& [key, least, most] : ranges) {
    const std::string found = "cell.toml:2: budget." + std::string(key) + " is ";
    const std::string expected =
        "; expected a whole number from " + std::to_string(least) + " to " + std::to_string(most);
    for (const std::string value :
         {"0", "-1", "-9223372036854775808", "7.5", "true", "\"many\"", "9223372036854775807"}) {
      EXPECT_EQ(error_message_for("[budget]\n" + std::string(key) + " = " + value + "\n"),
                found + value + expected);
    }
    for (const int value : {least - 1, most + 1}) {
      const std::string text = std::to_string(value);
      EXPECT_EQ(error_message_for("[budget]\n" + std::string(key) + " = " + text + "\n"),
                found + text + expected);
    }
    for (const int value : {least, most}) {
      EXPECT_EQ(error_message_for("[budget]\n" + std::string(key) + " = " + std::to_string(value)),
                "accepted");
    }
  }
}

CellFiles copies_of_the_pen(int tools) {
  CellFiles files;
  files.tools.count = tools;
  for (int t = 0; t < tools; ++t) {
    Tool& tool = files.tools.items[static_cast<std::size_t>(t)];
    tool = default_cell().tools.items[0];
    tool.name[0] = static_cast<char>('a' + t);
  }
  return files;
}

// The text `more` starts on line 2 of the cell file.
Cell cell_with_pens(int tools, const std::string& more) {
  const CellFiles carried = copies_of_the_pen(tools);
  std::string list;
  for (int t = 0; t < tools; ++t) {
    list += '"' + std::string(carried.tools.items[static_cast<std::size_t>(t)].name.data()) + "\",";
  }
  return cell_from_text("tools = [" + list + "]\n" + more, "cell.toml", &carried);
}

TEST(CellBudget, HasRoomForEveryListedMarkerAndAsManyStraysWhereNothingIsSaid) {
  const auto blobs_with = [](int tools) { return limits_of(cell_with_pens(tools, "")).blobs; };
  EXPECT_EQ(blobs_with(5), 64);
  EXPECT_EQ(blobs_with(8), 80);
  EXPECT_EQ(blobs_with(16), 160);
}

TEST(CellBudget, RefusesFewerBlobsThanTheListedToolsHaveMarkers) {
  EXPECT_EQ(limits_of(cell_with_pens(5, "[budget]\nblobs = 25\n")).blobs, 25);
  try {
    (void)cell_with_pens(5, "[budget]\ntools = 6\nblobs = 24\n");
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "cell.toml:4: budget.blobs is 24, but the listed tools have 25 markers, one blob "
                 "each; expected at least 25");
  }
}

TEST(CellBudget, HasRoomForEightRowsOfEachBlobInOneBandWhereNothingIsSaid) {
  const auto runs_with = [](const std::string& budget) {
    return limits_of(cell_from_text("[budget]\n" + budget, "cell.toml")).runs_per_band;
  };
  EXPECT_EQ(runs_with(""), 512);
  EXPECT_EQ(runs_with("blobs = 20\n"), 512);
  EXPECT_EQ(runs_with("blobs = 100\n"), 800);
  EXPECT_EQ(runs_with("blobs = 100\nruns_per_band = 300\n"), 300);
}

TEST(CellBudget, CoversToolsThatJoinAfterReading) {
  Cell cell = default_cell();
  cell.tools.items[1] = cell.tools.items[0];
  cell.tools.count = 2;
  EXPECT_EQ(limits_of(cell).tools, 2);
}

TEST(CellBudget, RefusesMoreToolsThanTheBudgetCovers) {
  const CellFiles carried = [] {
    CellFiles files;
    files.tools = default_cell().tools;
    files.tools.items[1] = files.tools.items[0];
    files.tools.items[1].name[0] = 'q';
    files.tools.count = 2;
    return files;
  }();
  try {
    (void)cell_from_text("tools = [\"pen\", \"qen\"]\n[budget]\ntools = 1\n", "cell.toml",
                         &carried);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "cell.toml:3: budget.tools is 1, but 2 tools are listed; expected at least 2");
  }
  std::string many = "name = \"many\"\ntools = [";
  for (int i = 0; i < 17; ++i) many += "\"pen\",";
  EXPECT_EQ(error_message_for(many + "]\n"), "cell.toml:2: 17 tools; expected at most 16");
}

// Unprojection takes no step for a pinhole camera and six for AHAT.
TEST(CellBudget, ACameraPutInItsPlaceBringsTheStepsOfItsLens) {
  Cell cell = default_cell();
  EXPECT_EQ(limits_of(cell).ray_steps, 6);
  Camera pinhole = cell.camera;
  pinhole.model.lens = Lens::pinhole;
  set_camera(cell, pinhole);
  EXPECT_EQ(limits_of(cell).ray_steps, 0);
}

}  // namespace
}  // namespace glint
