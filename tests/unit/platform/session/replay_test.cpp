#include "platform/session/replay.hpp"

#include "tests/unit/platform/session/short_run.hpp"

namespace glint {
namespace {

class Replay : public testing::TestWithParam<const char*> {};

TEST_P(Replay, DecidesAlikeWithOneWorkerAndWithTwo) {
  TemporaryFolder folder;
  const SessionResult run = short_run(short_cell(1.5, GetParam()), folder.path());
  ASSERT_TRUE(run.recording.complete());
  ASSERT_GT(run.accuracy.poses, 50);
  for (const int workers : {1, 2}) {
    ReplayOptions options;
    options.workers = workers;
    const ReplayResult result = replay(run.recording_file, options);
    EXPECT_TRUE(result.agrees()) << result.mismatches << " differ, first " << result.first_mismatch;
    EXPECT_EQ(result.output_sha256, run.output_sha256);
    EXPECT_EQ(result.records, run.ticks - 3);  // none before the first frame names its tools
  }
}

INSTANTIATE_TEST_SUITE_P(AtEveryLevel, Replay, testing::Values("full", "roi", "blobs", "outputs"),
                         [](const auto& level) { return std::string(level.param); });

TEST(Replay, GivesTheSameBytesAsARunWithTwoWorkers) {
  TemporaryFolder one, two;
  Cell cell = short_cell(1.0);
  const std::string expected = short_run(cell, one.path()).output_sha256;
  cell.workers = 2;
  EXPECT_EQ(short_run(cell, two.path()).output_sha256, expected);
}

TEST(Replay, SeesADifferentSettingAsADifference) {
  TemporaryFolder folder;
  Cell cell = short_cell(0.5);
  // The recording's cell asks for another actuation time than the run used: what replays is the
  // recording's, so every record must differ.
  const std::string asked = "actuation_delay_ms = 0";
  cell.text.replace(cell.text.find(asked), asked.size(), "actuation_delay_ms = 9");
  const SessionResult run = short_run(cell, folder.path());
  const ReplayResult result = replay(run.recording_file, {});
  EXPECT_FALSE(result.agrees());
  EXPECT_GT(result.mismatches, 50);
}

}  // namespace
}  // namespace glint
