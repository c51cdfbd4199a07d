// Rate groups of a companion computer on one core: with bounds, an overrun is detected ahead; held
// buttons are published in the samples.
#include "platform/runtime/session/session_groups.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "platform/apps/board/board_run.hpp"
#include "platform/input_error.hpp"
#include "platform/sinks/can/candump_line.hpp"

namespace glint::board_groups_test {
namespace {

constexpr std::uint32_t k_frames = 3, k_ticks = 4;
// Longer than any machine needs for a black frame, so the test does not depend on its speed.
constexpr Duration k_deadline = milliseconds(20'000);

class BoardGroupsTest : public testing::Test {
 protected:
  BoardGroupsTest()
      : folder_(std::filesystem::temp_directory_path() /
                ("glint_board_groups_" + std::to_string(::getpid()))) {
    std::filesystem::create_directory(folder_);
    cell_ = default_cell();
    cell_.record.file.clear();
    cell_.files = {"", ""};
    cell_.dds.on = false;
    cell_.realtime = true;
    cell_.deadlines.frame = cell_.deadlines.tick = k_deadline;
    black_.width = black_.height = 512;
    black_.reflectivity_16.resize(512 * 512);
    black_.depth.resize(512 * 512);
  }
  ~BoardGroupsTest() override { std::filesystem::remove_all(folder_); }

  // Runs frames, then ticks, each released when due. If `pressed`, draw is pressed first.
  [[nodiscard]] CompanionResult run_with(const NodeWcets& bounds, bool pressed = false,
                                         std::uint64_t first_tick = 0,
                                         std::uint64_t ticks = k_ticks) const {
    SessionOptions options;
    options.out = folder_.string();
    options.with_reader = false;
    options.plan = schedule_on_one_core(cell_, -1, bounds);
    Sinks sinks(cell_, options, 0);
    if (pressed) sinks.offer_button({Time{}, Button::draw, true});
    Time now;
    SessionGroups groups(cell_, options, {k_frames, 0}, sinks, nullptr, [&now] { return now; }, 0,
                         {});
    for (std::uint32_t frame = 1; frame <= k_frames; ++frame) {
      const Time mid_exposure = Time{} + milliseconds(22 * frame);
      now = mid_exposure + milliseconds(5);
      ArrivedFrame arrived;
      arrived.frame = black_.view(mid_exposure, now, frame);
      groups.process(arrived);
    }
    for (std::uint64_t tick = 0; tick < ticks; ++tick) {
      now = Time{} + milliseconds(100 + 4 * static_cast<std::int64_t>(tick));
      groups.tick(first_tick + tick, now, now);
    }
    CompanionResult result;
    groups.report(result);
    return result;
  }

  static NodeWcets every_node(Duration bound) {
    return {std::vector<std::int64_t>(Tracker::node_count, bound.nanoseconds),
            std::vector<std::int64_t>(Output::node_count, bound.nanoseconds)};
  }

  std::filesystem::path folder_;
  Cell cell_;
  FrameBuffer black_;
};

TEST_F(BoardGroupsTest, NoticeAheadThatWhatRemainsCannotBeInTime) {
  const CompanionResult result = run_with(every_node(k_deadline + Duration{1}));
  EXPECT_EQ(result.frame_overruns.will_miss, k_frames);
  EXPECT_EQ(result.tick_overruns.will_miss, k_ticks);
  EXPECT_EQ(result.frame_overruns.missed + result.tick_overruns.missed, 0u);
}

TEST_F(BoardGroupsTest, GoOnWhereWhatRemainsFitsOrNoBoundIsKnown) {
  for (const NodeWcets& bounds : {every_node(microseconds(1)), NodeWcets{}}) {
    const CompanionResult result = run_with(bounds);
    EXPECT_EQ(result.frames, k_frames);
    EXPECT_EQ(result.frame_overruns.total() + result.tick_overruns.total(), 0u);
  }
}

TEST_F(BoardGroupsTest, RefuseAMethodThatTheProgramDoesNotHave) {
  cell_.method = Method::baseline;
  EXPECT_THROW((void)run_with({}), InputError);
}

TEST_F(BoardGroupsTest, SayWhetherAButtonIsHeld) {
  const std::string held = run_with({}, true).output_sha256;
  EXPECT_EQ(held, run_with({}, true).output_sha256);
  EXPECT_NE(held, run_with({}).output_sha256);
}

// Data bytes of the run's logged frames with this identifier, in order.
std::vector<std::vector<std::uint8_t>> sent_as(std::uint32_t identifier,
                                               const std::filesystem::path& log) {
  std::vector<std::vector<std::uint8_t>> data;
  std::ifstream file(log);
  for (std::string line; std::getline(file, line);) {
    const auto record = parse_candump(line);
    if (!record || record->frame.identifier != identifier) continue;
    data.emplace_back(record->frame.bytes().begin(), record->frame.bytes().end());
  }
  return data;
}

TEST_F(BoardGroupsTest, SayByTheHeartbeatThatTheFrameThreadHangs) {
  cell_.can.sink = "log:can.log";
  (void)run_with({}, false, 0, 300);  // ticks for 1.2 s after the last frame
  const auto heartbeats = sent_as(0x720, folder_ / "can.log");
  ASSERT_EQ(heartbeats.size(), 12u);
  EXPECT_EQ(heartbeats[0][0], 0x00) << "boot-up";
  EXPECT_EQ(heartbeats[1][0], 0x05) << "operational";
  EXPECT_EQ(heartbeats[11][0], 0x7F) << "pre-operational";
}

// A reader treats a repeated counter as a repeated frame.
TEST_F(BoardGroupsTest, AdvanceTheCounterOfTheirCanFramesBeyondTwoToThe32Ticks) {
  cell_.can.sink = "log:can.log";
  constexpr std::uint64_t k_wrap = std::uint64_t{1} << 32;
  (void)run_with({}, false, k_wrap - 5, 20);
  const auto quality = sent_as(0x1A4, folder_ / "can.log");
  ASSERT_EQ(quality.size(), 20u);
  for (std::size_t i = 0; i < quality.size(); ++i) {
    EXPECT_EQ(quality[i][1] & 0xFU, (k_wrap - 5 + i) % 15) << "tick 2^32 - 5 + " << i;
  }
}

}  // namespace
}  // namespace glint::board_groups_test
