// Tools that are added and removed during a session, and in its replay.
#include "platform/runtime/session/tool_roster.hpp"
#include "tests/unit/platform/runtime/session/same_bytes.hpp"
#include "tests/unit/platform/runtime/session/short_run.hpp"

namespace glint {
namespace {

// The pen is present for 1 s, absent for 0.5 s, then present again.
Cell pen_removed_and_added(const char* level) {
  Cell cell = short_cell(2.5, level);
  cell.tool_changes = {{Time{1'000'000'000}, 0}, {Time{1'500'000'000}, k_all_tools}};
  return cell;
}

class ToolsThatChange : public testing::TestWithParam<const char*> {};

TEST_P(ToolsThatChange, AreNotTrackedWhileTheyAreAway) {
  TemporaryFolder folder;
  const SessionResult run = short_run(pen_removed_and_added(GetParam()), folder.path());
  int away = 0, seen_before = 0, seen_after = 0;
  for (std::size_t f = 0; f < run.outcomes.size(); ++f) {
    const ToolOutcome& pen = run.outcomes[f].tools[0];
    away += pen.present ? 0 : 1;
    if (!pen.present) {
      EXPECT_FALSE(pen.seen) << f;
      EXPECT_EQ(pen.reason, Reason::tool_changed) << f;
    }
    if (pen.seen) ++(away == 0 ? seen_before : seen_after);
  }
  EXPECT_NEAR(away, 0.5 * 45, 2);
  EXPECT_GT(seen_before, 35);
  EXPECT_GT(seen_after, 35);
}

TEST_P(ToolsThatChange, AreTheSameInAReplay) {
  TemporaryFolder folder;
  const SessionResult run = short_run(pen_removed_and_added(GetParam()), folder.path());
  for (const int workers : {1, 2}) expect_same_bytes(run.recording_file, run, workers);
}

INSTANTIATE_TEST_SUITE_P(AtEveryLevel, ToolsThatChange, testing::Values("full", "roi", "blobs"),
                         [](const auto& level) { return std::string(level.param); });

TEST(ToolRoster, PublishesEachChangeOnceInATellingVersion) {
  const Cell cell = pen_removed_and_added("roi");
  ToolRoster roster(cell);
  auto& published = roster.published();
  ASSERT_TRUE(published.sample());
  EXPECT_EQ(published.version(), tools_version(1, k_all_tools));
  roster.apply_changes(Time{999'999'999});
  EXPECT_FALSE(published.sample());
  roster.apply_changes(Time{1'000'000'000});
  ASSERT_TRUE(published.sample());
  EXPECT_EQ(tools_in(published.version()), 0);
  EXPECT_FALSE(published.value().items[0].present());
  roster.apply_changes(Time{3'000'000'000});
  ASSERT_TRUE(published.sample());
  EXPECT_EQ(published.version(), tools_version(3, k_all_tools));
  EXPECT_TRUE(published.value().items[0].present());
  EXPECT_EQ(tools_in(1), k_all_tools);  // version in an older recording
}

TEST(ToolRoster, TakesUpWhatWasAskedForBesideTheCellsChanges) {
  Cell cell = default_cell();
  cell.tools.count = 2;
  cell.tools_at_start = 0b01;
  cell.tool_changes = {{Time{1'000'000'000}, 0b00}};  // tool 0 is removed
  ToolRequests requests;
  ToolRoster roster(cell, &requests);
  const auto there_at = [&](std::int64_t ns) {
    roster.apply_changes(Time{ns});
    (void)roster.published().sample();
    return tools_in(roster.published().version());
  };
  EXPECT_EQ(there_at(0), 0b01);
  requests.ask(1, true);
  EXPECT_EQ(there_at(1000), 0b11);
  requests.ask(0, false);
  requests.ask(1, false);
  requests.ask(0, true);  // the last of several requests for one tool counts
  EXPECT_EQ(there_at(2000), 0b01);
  const std::uint64_t version = roster.published().version();
  requests.ask(1, false);
  EXPECT_EQ(there_at(3000), 0b01);
  EXPECT_EQ(roster.published().version(), version) << "nothing changed";
  requests.ask(1, true);
  EXPECT_EQ(there_at(1'000'000'000), 0b10) << "the cell's change names only the first";
}

}  // namespace
}  // namespace glint
