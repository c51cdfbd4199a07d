#include "platform/session/replay.hpp"

#include <fstream>

#include "platform/cells/tool_writer.hpp"
#include "tests/unit/platform/session/same_bytes.hpp"
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
    const ReplayResult result = expect_same_bytes(run.recording_file, run, workers);
    EXPECT_EQ(result.records, run.ticks - 3);  // none before the first frame names its tools
  }
}

// What the camera's bias took off a marker's range and how bright it was must be in the recording,
// as the tool's bias must be.
TEST_P(Replay, TakesAToolsOwnDepthBiasOff) {
  TemporaryFolder folder;
  const std::string cell_file = folder.path() + "/cell.toml";
  Tool own = default_cell().tools.items[0];
  own.depth_bias = {0.004, 0.002, 0.001, 0.2, 1.2};
  std::ofstream(folder.path() + "/own.toml") << tool_toml_text(own, "with a bias of its own");
  std::ofstream(cell_file) << "tools = [\"own.toml\"]\n[camera.depth_bias]\noffset_mm = 3\n"
                              "range_mm = [200, 1200]\n[record]\nlevel = \""
                           << GetParam() << "\"\n";
  const SessionResult run = short_run(shortened(load_cell(cell_file), 1.0), folder.path());
  ASSERT_GT(run.accuracy.poses, 30);
  expect_same_bytes(run.recording_file, run);
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

// A lens that is not the built-in one: without it the recording would replay to other bytes.
TEST(Replay, NeedsNoFileThatTheCellNamed) {
  TemporaryFolder folder;
  const std::string cell_file = folder.path() + "/cell.toml", lens = folder.path() + "/lens.toml";
  std::ofstream(lens) << "[camera]\nlens = \"brown\"\nwidth = 512\nheight = 512\nfx_px = 260.0\n"
                         "fy_px = 260.0\ncx_px = 256.0\ncy_px = 256.0\n"
                         "k1_k2_p1_p2_k3_k4_k5_k6 = [-0.05, 0.01, 0, 0, 0, 0, 0, 0]\n"
                         "field_tangent = 1.4\n";
  std::ofstream(cell_file) << "[camera]\nfile = \"lens.toml\"\n";
  const Cell cell = shortened(load_cell(cell_file), 1.0);
  ASSERT_EQ(cell.camera.model.fx, 260.0);
  const SessionResult run = short_run(cell, folder.path());
  ASSERT_GT(run.accuracy.poses, 30);
  std::filesystem::remove(lens);
  expect_same_bytes(run.recording_file, run);
}

}  // namespace
}  // namespace glint
