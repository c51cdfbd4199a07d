#include "platform/runtime/session/replay.hpp"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <functional>
#include <string_view>
#include <utility>
#include <vector>

#include "platform/cells/tool_writer.hpp"
#include "platform/input_error.hpp"
#include "platform/runtime/session/release_records.hpp"
#include "platform/sinks/record/mcap_format.hpp"
#include "tests/unit/platform/runtime/session/same_bytes.hpp"
#include "tests/unit/platform/runtime/session/short_run.hpp"
#include "tests/unit/text_of.hpp"

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
    EXPECT_EQ(result.records, run.ticks - 3);  // no output before the first frame
  }
}

// The recording must contain each marker's peak value and camera bias correction, and the tool's
// own bias, which replaces the camera's.
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

// A run with chunks of one second, at every level that a replay recomputes.
class ReplayOfWhatIsLeft : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    run_ = short_run(short_cell(seconds(), GetParam()), folder_.path());
    bytes_ = text_of(run_.recording_file);
  }
  // At level full a chunk holds few frames, at other levels one second of them.
  static double seconds() { return std::string_view(GetParam()) == "full" ? 1.4 : 3.5; }
  // Offset of chunk `number`, at its record kind (6) and length.
  std::size_t chunk(int number) const {
    std::size_t at = k_mcap_magic.size();
    for (;;) {
      std::uint64_t length = 0;
      std::memcpy(&length, bytes_.data() + at + 1, sizeof length);
      if (bytes_[at] == '\6' && number-- == 0) return at;
      at += k_mcap_heading_bytes + length;
    }
  }
  ReplayResult replayed(const std::string& bytes) {
    const std::string path = folder_.path() + "/left.mcap";
    std::ofstream(path, std::ios::binary) << bytes;
    EXPECT_THROW((void)replay(path, {}), InputError);
    ReplayOptions options;
    options.tolerance.truncated = true;
    return replay(path, options);
  }

  TemporaryFolder folder_;
  SessionResult run_;
  std::string bytes_;
};

TEST_P(ReplayOfWhatIsLeft, LosesADamagedChunkAlone) {
  std::string bytes = bytes_;
  bytes[chunk(1) + 3000] ^= 1;
  const ReplayResult result = replayed(bytes);
  EXPECT_EQ(result.losses.chunks, 1);
  EXPECT_FALSE(result.losses.at_least);
  EXPECT_GE(result.losses.frames, 4);
  EXPECT_LT(result.losses.frames, 70);
  EXPECT_EQ(result.losses.frames + result.frames, run_.frames);
  EXPECT_TRUE(result.agrees()) << result.mismatches;
  EXPECT_GT(result.records_compared, 10);
  EXPECT_GT(result.records, result.records_compared + 58 * seconds())
      << "behind the gap it goes on";
  EXPECT_GT(result.records_recorded, 143 * seconds());
}

TEST_P(ReplayOfWhatIsLeft, CountsWhatACutFileLacks) {
  const std::size_t kept = chunk(2) + 20'000;
  const ReplayResult result = replayed(bytes_.substr(0, kept));
  EXPECT_EQ(result.losses.bytes, 20'000U);
  EXPECT_GT(result.losses.frames, 0);
  EXPECT_TRUE(result.losses.at_least);
  EXPECT_TRUE(result.agrees()) << result.mismatches;
  EXPECT_GT(result.records_compared, 20);
}

INSTANTIATE_TEST_SUITE_P(AtEveryLevel, ReplayOfWhatIsLeft, testing::Values("full", "roi", "blobs"),
                         [](const auto& level) { return std::string(level.param); });

// Possible remains of an interrupted run: frames without ticks, or ticks without frames.
TEST(Replay, RefusesARecordingWithoutAnOutputRecord) {
  const TemporaryFolder folder;
  const SessionResult run = short_run(short_cell(0.3, "blobs"), folder.path());
  const std::string file = folder.path() + "/few.mcap";
  for (const bool keep_frames : {true, false}) {
    rewrite(run.recording_file, file, [keep_frames](std::vector<RecordedMessage>& messages) {
      std::erase_if(messages, [keep_frames](const RecordedMessage& message) {
        const auto* const choice = std::get_if<ChoiceRecord>(&message);
        const bool of_tick = std::holds_alternative<OutputMessage>(message);
        return of_tick || (choice == nullptr && !keep_frames) ||
               (choice != nullptr && (choice->group == k_frame_group) != keep_frames);
      });
    });
    try {
      (void)replay(file, {});
      FAIL() << "was replayed";
    } catch (const InputError& error) {
      const std::string found = keep_frames ? "14 frames and 0 ticks" : "0 frames and 3 ticks";
      EXPECT_EQ(std::string(error.what()),
                file + ": no output to replay: " + found +
                    " without output records; expected a recording of a run with ticks");
    }
  }
}

// Reorders the records of activations. `position` returns the position of frame v's records, or of
// those of the n-th tick that read frame v.
using RecordPosition = std::function<double(bool is_tick, std::uint64_t v, int n)>;
void move_records(std::vector<RecordedMessage>& messages, const RecordPosition& position) {
  std::vector<std::pair<double, RecordedMessage>> placed;
  std::uint64_t frames = 0, read = 0;
  int n = 0;
  double at = 0;
  for (RecordedMessage& message : messages) {
    if (std::holds_alternative<HeadPose>(message)) at = position(false, ++frames, 0);
    if (const auto* choice = std::get_if<ChoiceRecord>(&message);
        choice != nullptr && choice->group == k_tick_group) {
      n = read == choice->versions[0] ? n + 1 : 1;
      at = position(true, read = choice->versions[0], n);
    }
    placed.emplace_back(at, std::move(message));
  }
  std::stable_sort(placed.begin(), placed.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  for (std::size_t i = 0; i < placed.size(); ++i) messages[i] = std::move(placed[i].second);
}

// A run with overruns of two successive frames and of one tick.
class ReplayOfOtherOrder : public testing::TestWithParam<graph::OverrunPolicy> {
 protected:
  SessionResult run(double seconds) const {
    Cell cell = short_cell(seconds, "blobs");
    cell.overrun.frame = GetParam();
    SessionOptions options;
    options.out = folder_.path();
    for (const std::uint64_t at : {20u, 21u}) {
      options.injections.push_back({"", 1, false, at, cell.deadlines.frame + Duration{1}});
    }
    options.injections.push_back({"", 0, true, 100, cell.deadlines.tick + Duration{1}});
    return run_simulated(cell, options);
  }
  std::string moved(const SessionResult& run, const RecordPosition& position) const {
    std::string file = folder_.path() + "/moved.mcap";
    rewrite(run.recording_file, file,
            [&](std::vector<RecordedMessage>& messages) { move_records(messages, position); });
    return file;
  }
  TemporaryFolder folder_;
};

// The tick thread was preempted between its output and its record.
TEST_P(ReplayOfOtherOrder, FindsTheEstimatesOfATickThatStandsBehindLaterFrames) {
  const SessionResult run = this->run(1.0);
  for (const int late : {1, 3}) {
    const ReplayResult result =
        expect_same_bytes(moved(run,
                                [late](bool is_tick, std::uint64_t v, int /*n*/) {
                                  return static_cast<double>(v) + (is_tick ? late + 0.5 : 0);
                                }),
                          run);
    EXPECT_EQ(result.ticks, run.ticks);
    EXPECT_EQ(result.overruns, 3);
  }
}

// The frame thread was preempted: it published its estimates before their record.
TEST_P(ReplayOfOtherOrder, WaitsForTheFrameThatATickRead) {
  const SessionResult run = this->run(1.0);
  const ReplayResult result = expect_same_bytes(
      moved(run,
            [](bool is_tick, std::uint64_t v, int n) {
              return static_cast<double>(v) + (!is_tick ? 0 : n <= 2 ? -0.5 : 0.5);
            }),
      run);
  EXPECT_EQ(result.ticks, run.ticks);
  EXPECT_EQ(result.versions_missing, 0);
}

TEST_P(ReplayOfOtherOrder, HoldsABoundedNumberOfFramesBack) {
  const SessionResult run = this->run(2.0);
  ASSERT_GT(run.frames, 80);
  const ReplayResult result =
      replay(moved(run, [](bool is_tick, std::uint64_t v,
                           int /*n*/) { return static_cast<double>(v) + (is_tick ? 70.5 : 0); }),
             {});
  EXPECT_FALSE(result.agrees());
  EXPECT_EQ(result.frames, run.frames);
  EXPECT_GT(result.versions_missing, 0);
  EXPECT_EQ(result.ticks + result.versions_missing, run.ticks);
}

INSTANTIATE_TEST_SUITE_P(ByPolicy, ReplayOfOtherOrder,
                         testing::Values(graph::OverrunPolicy::skip_output,
                                         graph::OverrunPolicy::predict),
                         [](const auto& policy) { return std::string(name_of(policy.param)); });

TEST(Replay, SeesADifferentSettingAsADifference) {
  TemporaryFolder folder;
  Cell cell = short_cell(0.5);
  // The cell in the recording is edited to another actuation delay than the run's. The replay uses
  // the recorded cell, so every output record must differ.
  const std::string asked = "actuation_delay_ms = 0";
  cell.text.replace(cell.text.find(asked), asked.size(), "actuation_delay_ms = 9");
  const SessionResult run = short_run(cell, folder.path());
  const ReplayResult result = replay(run.recording_file, {});
  EXPECT_FALSE(result.agrees());
  EXPECT_GT(result.mismatches, 50);
}

// Not the built-in lens: the replay differs unless the recording contains the lens.
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
