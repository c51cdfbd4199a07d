// A companion computer's complete run: the cell's parts outside the groups, and a replay.
#include "platform/apps/board/board_run.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "platform/apps/board/frame_loop.hpp"
#include "platform/apps/board/worst_frames.hpp"
#include "platform/input_error.hpp"
#include "platform/runtime/session/replay.hpp"
#include "platform/sim/simulator.hpp"
#include "platform/sources/scenario_of.hpp"
#include "tests/unit/platform/runtime/session/followed_robot.hpp"

namespace glint::board_run_test {
namespace {

constexpr int k_frames = 12;
constexpr std::int64_t k_shown = 68;  // 1.5 s

class BoardRun : public testing::Test {
 protected:
  BoardRun()
      : folder_(std::filesystem::temp_directory_path() /
                ("glint_board_run_" + std::to_string(::getpid()))) {
    std::filesystem::create_directory(folder_);
    cell_.dds.on = false;
  }
  ~BoardRun() override { std::filesystem::remove_all(folder_); }

  // Frames of the cell's own scenario; every fourth is a worst input.
  [[nodiscard]] std::string loop_file() const {
    const sim::Simulator simulator(scenario_of(cell_));
    FrameLoopHeader header;
    header.width = header.height = 512;
    header.has_depth = 1;
    header.frames = k_frames;
    header.period_ns = cell_.camera.period.nanoseconds;
    FrameLoopWriter writer(path("loop"), header);
    sim::SimFrame frame;
    for (int i = 0; i < k_frames; ++i) {
      simulator.render(450 + i, frame);
      LoopFrame entry;
      entry.exposure_to_arrival_ns = (frame.arrival - frame.mid_exposure).nanoseconds;
      entry.head_valid = 1;
      for (int k = 0; k < 3; ++k) entry.position_m[k] = frame.head.T_world_camera.translation[k];
      for (int k = 0; k < 4; ++k) {
        entry.rotation_xyzw[k] = frame.head.T_world_camera.rotation.coeffs()[k];
      }
      if (i % 4 == 3) {
        entry.kind = LoopFrameKind::worst;
        draw(static_cast<WorstFrame>(i / 4), 60'000, 0, 500, frame.pixels);
      }
      writer.add(entry, frame.pixels);
    }
    writer.close();
    return path("loop");
  }

  [[nodiscard]] CompanionResult run(const std::string& record) const {
    const FrameLoop loop(loop_file());
    CompanionOptions options;
    options.frames = k_shown;
    options.out = folder_.string();
    options.record = record;
    return run_companion(cell_, loop, options);
  }

  [[nodiscard]] std::string path(const std::string& name) const {
    return (folder_ / name).string();
  }

  std::filesystem::path folder_;
  Cell cell_ = default_cell();
};

TEST_F(BoardRun, RecordsOnlyWhatItIsAskedTo) {
  const CompanionResult result = run("");
  EXPECT_EQ(result.frames, k_shown);
  EXPECT_FALSE(result.background);
  EXPECT_TRUE(result.recording_file.empty());
  EXPECT_FALSE(std::filesystem::exists(path("run.mcap")));
}

class BoardRecording : public BoardRun, public testing::WithParamInterface<const char*> {};

TEST_P(BoardRecording, OfARobotThatIsFollowedReplaysToTheRunsHash) {
  cell_.record.level = GetParam();
  configure_box_robot(folder_.string(), 0, cell_);
  const CompanionResult result = run("board.mcap");
  EXPECT_EQ(result.frames, k_shown);
  EXPECT_GT(result.frames_tracked, k_shown / 4);
  EXPECT_EQ(result.heap_allocations_after_start, 0u);
  ASSERT_TRUE(result.background);
  EXPECT_GE(result.background->slices, 1u);
  EXPECT_GE(result.background->robot.followed, 1);
  EXPECT_GE(result.background->map.pictures, 1);
  ASSERT_TRUE(result.recording.complete()) << result.recording.reason;
  for (const int workers : {1, 2}) {
    ReplayOptions options;
    options.workers = workers;
    const ReplayResult again = replay(path("board.mcap"), options);
    EXPECT_EQ(again.frames, k_shown);
    EXPECT_EQ(again.mismatches, 0) << "first " << again.first_mismatch;
    EXPECT_EQ(again.versions_missing, 0);
    EXPECT_EQ(again.output_sha256, result.output_sha256);
  }
}

INSTANTIATE_TEST_SUITE_P(AtLevel, BoardRecording, testing::Values("roi", "blobs"),
                         [](const auto& level) { return std::string(level.param); });

TEST_F(BoardRun, RefusesDepthThatABoardCannotRead) {
  configure_box_robot(folder_.string(), 0, cell_);
  std::ofstream(path("999.depth.png")) << "any";
  try {
    (void)run("");
    ADD_FAILURE() << "accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(error.what(),
              path("999.depth.png") + ": a PNG, not supported on a board; expected NAME.depth.npy");
  }
}

TEST_F(BoardRun, RefusesACellThatChangesItsTools) {
  cell_.tool_changes.resize(1);
  EXPECT_THROW((void)run(""), InputError);
}

}  // namespace
}  // namespace glint::board_run_test
