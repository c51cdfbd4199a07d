// Output losses are counted, named and reported on CAN. An unsent tick has no state or latency.
#include "platform/runtime/session/losses.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <memory>
#include <string>
#include <vector>

#include "platform/lab/baseline/baseline_method.hpp"
#include "platform/runtime/session/loss_watch.hpp"
#include "platform/runtime/session/sent_ticks.hpp"
#include "tests/unit/platform/runtime/session/short_run.hpp"
#include "tests/unit/platform/runtime/session/unseen_pen.hpp"

namespace glint {
namespace {

TickOfFrames tick_of(std::uint64_t last, int at_ms, TrackState state) {
  TickOfFrames tick;
  tick.last = last;
  tick.at = Time{} + milliseconds(at_ms);
  tick.tools = 1;
  tick.all_accepted = true;
  tick.states[0] = state;
  return tick;
}

TEST(SentTicks, CountsATickWhenItsLastFrameHasLeft) {
  SentTicks ticks(4);
  TickOfFrames first = tick_of(5, 0, TrackState::measured);
  first.carries = true;
  first.latency.computing = microseconds(7);
  ticks.add(first, 0);
  ticks.add(tick_of(10, 4, TrackState::lost), 4);
  EXPECT_EQ(ticks.summary().ticks, 0u);
  EXPECT_TRUE(ticks.latencies().entries().empty());
  ticks.settle(9);
  EXPECT_EQ(ticks.summary().ticks, 1u);
  EXPECT_EQ(ticks.summary().tools[0].measured, 1u);
  EXPECT_EQ(ticks.latencies().entries().size(), 1u);
  ticks.settle(10);
  EXPECT_EQ(ticks.summary().tools[0].lost, 1u);
}

TEST(SentTicks, LeavesOutATickOfWhichAFrameWasRefused) {
  SentTicks ticks(4);
  TickOfFrames broken = tick_of(3, 0, TrackState::measured);
  broken.all_accepted = false;
  broken.carries = true;  // its first frame was sent
  ticks.add(broken, 3);
  ticks.settle(3);
  EXPECT_EQ(ticks.summary().ticks, 0u);
  EXPECT_EQ(ticks.latencies().entries().size(), 1u);
}

TEST(SentTicks, MeasuresGapsToEitherEnd) {
  SentTicks ticks(0);
  std::uint64_t frames = 0;
  const auto add = [&](int at_ms, TrackState state) {
    ++frames;
    ticks.add(tick_of(frames, at_ms, state), frames);
  };
  add(100, TrackState::none);
  add(104, TrackState::measured);
  add(116, TrackState::predicted);
  ticks.settle(frames);
  EXPECT_EQ(ticks.summary().longest_gap, milliseconds(12));
  EXPECT_EQ(ticks.summary().tools[0].longest_without_measurement, milliseconds(12));
  add(120, TrackState::lost);
  ticks.settle(frames);
  EXPECT_EQ(ticks.summary().tools[0].longest_without_measurement, milliseconds(16));
  EXPECT_EQ(ticks.summary().tools[0].none, 1u);
}

TEST(SentTicks, KeepsCountingInFixedMemoryAfterTheSinkFailed) {
  SentTicks ticks(4);
  for (std::uint64_t i = 1; i < 3 * k_can_in_flight_max; ++i) {
    ticks.add(tick_of(i, static_cast<int>(i), TrackState::measured), 2);
  }
  EXPECT_EQ(ticks.summary().ticks, 2u);
}

// Keeps every frame; rejects frames from a given number on.
class KeptFrames final : public CanSink {
 public:
  explicit KeptFrames(std::size_t accepted_max = SIZE_MAX) : accepted_max_(accepted_max) {}
  bool send(const CanFrame& frame, Time time) noexcept override {
    if (frames.size() >= accepted_max_) {
      ++refused_;
      return false;
    }
    frames.push_back(frame);
    times.push_back(time);
    return true;
  }
  void flush() noexcept override {}
  [[nodiscard]] CanSinkCounts counts() const noexcept override {
    return {frames.size(), 0, refused_, 0};
  }
  // Times of the emergencies for a loss of this kind.
  [[nodiscard]] std::vector<Time> emergencies(LossKind kind) const {
    const CanFrame wanted = lost_output_frame(32, static_cast<std::uint8_t>(kind));
    std::vector<Time> found;
    for (std::size_t i = 0; i < frames.size(); ++i) {
      if (frames[i].identifier == wanted.identifier && frames[i].data == wanted.data) {
        found.push_back(times[i]);
      }
    }
    return found;
  }
  std::vector<CanFrame> frames;
  std::vector<Time> times;

 private:
  std::size_t accepted_max_;
  std::uint64_t refused_ = 0;
};

TEST(LossEmergency, HasANameOfEachKindInTheTableOfMessages) {
  const CanSignal& lost = can_message("Emergency").signal("LostOutput");
  ASSERT_EQ(lost.names.size() + 1, k_loss_kinds);  // a CAN loss is not sent on CAN
  for (const CanValueName& name : lost.names) {
    std::string kind(name_of(static_cast<LossKind>(name.value)));
    for (char& letter : kind) letter = static_cast<char>(std::tolower(letter));
    EXPECT_EQ(name.name, kind) << name.value;
  }
}

TEST(LossEmergency, IsAtMostOneFrameASecondAndKind) {
  const TemporaryFolder folder;
  const Cell cell = short_cell(1);
  SinkOptions options;
  options.out = folder.path();
  Sinks sinks(cell, options, 0);
  KeptFrames can;
  LossCounters losses;
  TickSinks tick_sinks;
  tick_sinks.can = &can;
  tick_sinks.losses = &losses;
  TickGroupWithoutFrames pen(cell, sinks, tick_sinks);
  for (int i = 0; i < 100; ++i) pen.tick();
  EXPECT_TRUE(can.emergencies(LossKind::recording).empty()) << "nothing was lost yet";
  for (std::uint64_t i = 1; i <= 600; ++i) {  // 2.4 s
    losses.store(LossKind::recording, i);
    losses.store(LossKind::files, 3);
    pen.tick();
  }
  const auto recording = can.emergencies(LossKind::recording);
  ASSERT_EQ(recording.size(), 3u);
  EXPECT_EQ(recording[0], Time{} + milliseconds(400));
  EXPECT_EQ(recording[1] - recording[0], milliseconds(1000));
  EXPECT_EQ(recording[2] - recording[1], milliseconds(1000));
  const auto files = can.emergencies(LossKind::files);
  ASSERT_EQ(files.size(), 1u) << "no more of them were lost";
  EXPECT_EQ(files[0] - recording[0], milliseconds(4)) << "one a tick";
  EXPECT_TRUE(can.emergencies(LossKind::dds).empty());
}

TEST(LossEmergency, IsNotSentForCanItself) {
  const TemporaryFolder folder;
  const Cell cell = short_cell(1);
  SinkOptions options;
  options.out = folder.path();
  Sinks sinks(cell, options, 0);
  KeptFrames can(10);
  LossCounters losses;
  TickSinks tick_sinks;
  tick_sinks.can = &can;
  tick_sinks.losses = &losses;
  TickGroupWithoutFrames pen(cell, sinks, tick_sinks);
  for (int i = 0; i < 20; ++i) pen.tick();
  EXPECT_GT(losses.of(LossKind::can), 80u);
  EXPECT_TRUE(can.emergencies(LossKind::can).empty());
}

TEST(LossEmergency, NamesItsKindInAnErrorCodeOfItsOwn) {
  const CanFrame frame = lost_output_frame(32, static_cast<std::uint8_t>(LossKind::files));
  EXPECT_EQ(frame.identifier, 0xA0u);
  EXPECT_EQ(frame.length, 8);
  const std::array<std::uint8_t, 8> expected{0x83, 0xFF, 0x81, 3, 0, 0, 0, 0};
  EXPECT_TRUE(std::equal(expected.begin(), expected.end(), frame.data.begin()));
}

TEST(LostOutput, OfACanLogThatTheDiskRefusesHasNoLatency) {
  const TemporaryFolder folder;
  Cell cell = short_cell(0.5);
  cell.can.sink = "log:/dev/full";
  const SessionResult run = short_run(cell, folder.path());
  EXPECT_GT(run.can_frames, 500u);
  EXPECT_EQ(run.can.sent, 0u);
  EXPECT_EQ(run.can.failed, run.can_frames);
  EXPECT_TRUE(run.latencies.empty());
  EXPECT_EQ(run.sent.ticks, 0u);
  const auto losses = losses_of(run);
  ASSERT_EQ(losses.size(), 1u);
  EXPECT_EQ(losses[0].kind, "CAN");
  EXPECT_EQ(losses[0].count, run.can_frames);
  EXPECT_EQ(losses[0].text,
            std::to_string(run.can_frames) + " frames refused: disk full: No space left on device");
}

TEST(LostOutput, IsNoneOfAWholeRun) {
  const TemporaryFolder folder;
  const SessionResult run = short_run(short_cell(0.5), folder.path());
  EXPECT_TRUE(losses_of(run).empty());
  EXPECT_EQ(run.can.sent, run.can_frames);
  EXPECT_EQ(run.sent.tools[0].all(), run.sent.ticks);
  EXPECT_GT(run.latencies.size(), 20u);
  EXPECT_EQ(run.sent.longest_gap, milliseconds(4));
}

TEST(LostOutput, NamesEachKindWithItsCount) {
  SinkOutcome outcome;
  outcome.can.dropped = 1;
  outcome.dds.ring_dropped = 2;
  outcome.dds.poses_and_transforms_lost = 3;
  outcome.dds_was_read = true;
  outcome.dds_reader.missed = 4;
  outcome.recording.dropped = 5;
  outcome.recording.lost = 6;
  outcome.recording.ended_early = true;
  outcome.files_lost = 7;
  outcome.not_written = {"map.ply: cannot be written"};
  std::vector<std::uint64_t> counts;
  for (const Loss& loss : losses_of(outcome)) counts.push_back(loss.count);
  EXPECT_EQ(counts, (std::vector<std::uint64_t>{1, 2, 3, 4, 5, 6, 7, 0}));
  outcome = {};
  outcome.dds_reader_error = "dds: the reader process was ended by signal 9";
  ASSERT_EQ(lines_of(losses_of(outcome)).size(), 1u);
  EXPECT_EQ(lines_of(losses_of(outcome))[0],
            "lost, DDS: received count unknown: " + outcome.dds_reader_error);
}

TEST(SlowSource, IsBlamedForTheTicksWithoutAMeasurement) {
  const TemporaryFolder folder;
  SessionOptions options;
  options.out = folder.path();
  const SessionResult run = run_simulated(short_cell(1), options, milliseconds(60));
  const ToolTicks& tool = run.sent.tools[0];
  EXPECT_EQ(run.frames_late, run.frames);
  EXPECT_GT(run.duration_s, 2.5) << "45 frames of 60 ms each";
  EXPECT_GT(tool.lost, tool.all() / 2);
  // Unmeasured ticks without a late source: before the first frame is due and after the last frame.
  const std::uint64_t unmeasured = static_cast<std::uint64_t>(run.ticks) - tool.measured;
  EXPECT_NEAR(static_cast<double>(unmeasured - run.ticks_source_late), 62.5 + 1.5, 2.0)
      << "ticks in the 250 ms after the last frame and before the first is due";
}

TEST(SlowSource, IsNotBlamedWhereItIsInTime) {
  const TemporaryFolder folder;
  const SessionResult run = short_run(short_cell(1), folder.path());
  EXPECT_EQ(run.ticks_source_late, 0u);
  EXPECT_EQ(run.frames_late, 0);
  EXPECT_NEAR(run.duration_s, 1.23, 0.05) << "one second of frames and lost_after";
}

TEST(SeedMethod, GivesPosesInASession) {
  const TemporaryFolder folder;
  Cell cell = short_cell(1, "outputs");
  cell.method = Method::baseline;
  SessionOptions options;
  options.out = folder.path();
  options.method = [](const Cell& of) { return std::make_unique<BaselineMethod>(of); };
  const SessionResult run = run_simulated(cell, options);
  EXPECT_GT(run.accuracy.poses, run.frames / 2);
  EXPECT_GT(run.sent.tools[0].measured, run.sent.ticks / 2);
}

}  // namespace
}  // namespace glint
