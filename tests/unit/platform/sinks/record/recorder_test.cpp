#include "platform/sinks/record/recorder.hpp"

#include <gtest/gtest.h>
#include <pthread.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <thread>

#include "platform/input_error.hpp"
#include "platform/sinks/record/file_sync.hpp"
#include "platform/sinks/record/recording_reader.hpp"
#include "tests/unit/heap_count.hpp"
#include "tests/unit/platform/sinks/record/recording_samples.hpp"

// Replace the C library's functions.
namespace {
std::atomic<int> g_syncs{0};
std::atomic<bool> g_sync_fails{false}, g_sync_leaves_errno{false};
std::array<char, 16> g_sync_thread{};
}  // namespace

extern "C" int fdatasync(int /*descriptor*/) {
  pthread_getname_np(pthread_self(), g_sync_thread.data(), g_sync_thread.size());
  ++g_syncs;
  if (g_sync_fails) errno = g_syncs == 1 ? EIO : ENOSPC;
  if (g_sync_leaves_errno) errno = EINTR;
  return g_sync_fails ? -1 : 0;
}

namespace glint {
namespace {

RecorderSettings waiting() {
  RecorderSettings settings;
  settings.when_full = OverflowPolicy::wait;
  return settings;
}

TEST(Recorder, KeepsTheOrderInWhichTwoThreadsSawEachOther) {
  const TemporaryFolder folder;
  const std::string path = folder.file("run.mcap");
  constexpr std::uint64_t k_frames = 500;
  {
    Recorder recorder(path, sample_info(RecordingLevel::blobs), waiting());
    std::atomic<std::uint64_t> version{0};
    std::thread tick([&] {
      for (std::uint64_t i = 1, seen = 0; seen < k_frames; ++i) {
        seen = version.load(std::memory_order_acquire);
        ChoiceRecord choice = sample_choice(i);
        choice.group = 1;
        choice.versions[0] = seen;
        recorder.tick_lane().offer_choice(choice);
        std::this_thread::yield();
      }
    });
    for (std::uint64_t i = 1; i <= k_frames; ++i) {
      ChoiceRecord choice = sample_choice(i);
      choice.group = 0;
      recorder.frame_lane().offer_choice(choice);
      version.store(i, std::memory_order_release);
      std::this_thread::yield();
    }
    tick.join();
    EXPECT_TRUE(recorder.close().complete());
  }
  RecordingReader reader(path);
  std::uint64_t frames = 0, ticks = 0;
  while (const auto message = reader.next()) {
    const auto& choice = std::get<ChoiceRecord>(*message);
    if (choice.group == 0) {
      EXPECT_EQ(choice.activation, ++frames);
    } else {
      EXPECT_EQ(choice.activation, ++ticks);
      EXPECT_LE(choice.versions[0], frames) << "a tick stands before the frame that it read";
    }
  }
  EXPECT_EQ(frames, k_frames);
}

TEST(Recorder, KeepsEveryKindOfOffer) {
  const TemporaryFolder folder;
  const std::string path = folder.file("run.mcap");
  const FrameBuffer buffer = sample_frame(40, 30, 16);
  {
    Recorder recorder(path, sample_info(RecordingLevel::roi));
    const Rois rois{{Roi{10, 10, 20, 20}}, 1};
    EXPECT_TRUE(recorder.frame_lane().offer_frame(buffer.view({1}, {2}, 3), rois));
    EXPECT_TRUE(recorder.frame_lane().offer_head_pose(sample_head_pose(0)));
    EXPECT_TRUE(recorder.frame_lane().offer_markers(sample_markers(2)));
    EXPECT_TRUE(recorder.input_lane().offer_dropped({{1}, {2}, 3, Reason::frame_duplicate}));
    const PoseSample sample = sample_output(1);
    EXPECT_TRUE(recorder.tick_lane().offer_output(sample, record_of(sample)));
    recorder.add_closing_fact("frames", "1");
    const RecordingOutcome outcome = recorder.close();
    EXPECT_TRUE(outcome.complete()) << outcome.reason;
    EXPECT_EQ(outcome.messages, 7U);  // this level has no markers; 3 are ROS poses
  }
  RecordingReader reader(path);
  const auto frame = std::get<FrameMessage>(reader.next().value());
  EXPECT_EQ(frame.sequence, 3U);
  EXPECT_EQ(frame.pixels.depth[15 * 40 + 15], buffer.depth[15 * 40 + 15]);
  EXPECT_EQ(frame.pixels.depth[29 * 40 + 39], 0);
  EXPECT_TRUE(std::holds_alternative<HeadPose>(reader.next().value()));
  EXPECT_TRUE(std::holds_alternative<DroppedInput>(reader.next().value()));
  EXPECT_TRUE(std::holds_alternative<OutputMessage>(reader.next().value()));
  EXPECT_FALSE(reader.next());
  EXPECT_EQ(reader.facts().at("frames"), "1");
}

TEST(Recorder, KeepsMarkersAtLevelBlobs) {
  const TemporaryFolder folder;
  const std::string path = folder.file("run.mcap");
  Recorder recorder(path, sample_info(RecordingLevel::blobs));
  recorder.frame_lane().offer_markers(sample_markers(256));
  recorder.close();
  RecordingReader reader(path);
  EXPECT_EQ(std::get<MarkerFrame>(reader.next().value()).markers.count, 256);
}

TEST(Recorder, CountsItsFramesBeyondTwoToThe32) {
  const TemporaryFolder folder;
  const std::string path = folder.file("run.mcap");
  constexpr std::uint64_t k_first = (std::uint64_t{1} << 32) - 3;
  Recorder recorder(path, sample_info(RecordingLevel::blobs), waiting());
  for (std::uint64_t i = 0; i < 6; ++i) {
    MarkerFrame frame = sample_markers(1);
    frame.sequence = k_first + i;
    EXPECT_TRUE(recorder.frame_lane().offer_markers(frame));
  }
  recorder.close();
  RecordingReader reader(path);
  for (std::uint64_t i = 0; i < 6; ++i) {
    EXPECT_EQ(std::get<MarkerFrame>(reader.next().value()).sequence, k_first + i);
  }
}

TEST(Recorder, CountsWhatFoundNoRoomAndMarksTheRecordingIncomplete) {
  const TemporaryFolder folder;
  const std::string path = folder.file("run.mcap");
  RecorderSettings settings;
  settings.frame_lane_bytes = 4096;  // too small for a frame of 4800 bytes
  Recorder recorder(path, sample_info(RecordingLevel::full), settings);
  const FrameBuffer buffer = sample_frame(40, 30, 16);
  EXPECT_FALSE(recorder.frame_lane().offer_frame(buffer.view({1}, {2}, 3), {}));
  EXPECT_TRUE(recorder.frame_lane().offer_choice(sample_choice(1)));
  EXPECT_EQ(recorder.dropped(), 1U);
  const RecordingOutcome outcome = recorder.close();
  EXPECT_EQ(outcome.dropped, 1U);
  EXPECT_FALSE(outcome.complete());
  EXPECT_THROW(RecordingReader reader(path), InputError);
}

TEST(Recorder, WaitsForRoomWhereAskedTo) {
  const TemporaryFolder folder;
  const std::string path = folder.file("run.mcap");
  RecorderSettings settings = waiting();
  settings.tick_lane_bytes = 4096;
  Recorder recorder(path, sample_info(RecordingLevel::roi), settings);
  for (std::uint64_t i = 1; i <= 300; ++i)
    ASSERT_TRUE(recorder.tick_lane().offer_choice(sample_choice(i)));
  const RecordingOutcome outcome = recorder.close();
  EXPECT_TRUE(outcome.complete());
  EXPECT_EQ(outcome.messages, 300U);
}

TEST(Recorder, OffersWithoutTouchingTheHeap) {
  const TemporaryFolder folder;
  const std::string path = folder.file("run.mcap");
  Recorder recorder(path, sample_info(RecordingLevel::full));
  const FrameBuffer buffer = sample_frame(40, 30, 16);
  const MarkerFrame markers = sample_markers(20);
  const PoseSample sample = sample_output(1);
  const auto record = record_of(sample);
  const HeapCount counter;
  for (int i = 0; i < 200; ++i) {
    recorder.frame_lane().offer_frame(buffer.view({i}, {i}, 3), {});
    recorder.frame_lane().offer_markers(markers);
    recorder.frame_lane().offer_head_pose(sample_head_pose(i));
    recorder.tick_lane().offer_choice(sample_choice(1));
    recorder.tick_lane().offer_output(sample, record);
    recorder.input_lane().offer_dropped({});
    recorder.input_lane().offer_button({{1}, Button::draw, true});
    recorder.input_lane().offer_pen_buttons({1, {1}, 1});
  }
  EXPECT_EQ(counter.count(), 0u);
  const std::vector<int> seen(3);
  EXPECT_EQ(counter.count(), AllocationCounter::available() ? 1u : 0u);
}

// The recorder's sync thread, as observed by the replaced functions.
TEST(Recorder, BringsItsFileToTheDiskAtASteadyRateByAThreadOfItsOwn) {
  const TemporaryFolder folder;
  RecorderSettings settings;
  settings.file.sync_period = milliseconds(1);
  g_syncs = 0;
  Recorder recorder(folder.file("run.mcap"), sample_info(RecordingLevel::roi), settings);
  for (int waited_ms = 0; g_syncs < 3 && waited_ms < 60'000; ++waited_ms) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_GE(g_syncs, 3);
  EXPECT_TRUE(recorder.close().complete());
  EXPECT_STREQ(g_sync_thread.data(), "glint_sync");
}

void wait_for_syncs(int count) {
  for (int waited_ms = 0; g_syncs < count && waited_ms < 60'000; ++waited_ms)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

TEST(FileSync, KeepsTheFirstErrorAndNoneOfASynchronisationThatSucceeded) {
  g_syncs = 0;
  g_sync_leaves_errno = true;
  {
    FileSync sync(-1, milliseconds(1));
    wait_for_syncs(3);
    sync.stop();
    EXPECT_EQ(sync.error(), 0);
  }
  g_sync_leaves_errno = false;
  g_syncs = 0;
  g_sync_fails = true;
  FileSync sync(-1, milliseconds(1));
  wait_for_syncs(3);
  sync.stop();
  sync.stop();
  g_sync_fails = false;
  EXPECT_EQ(sync.error(), EIO);
  const int syncs = g_syncs;
  EXPECT_GE(syncs, 3);
}

TEST(Recorder, IsNotCompleteWhereTheDiskRefuses) {
  const TemporaryFolder folder;
  RecorderSettings settings;
  settings.file.sync_period = milliseconds(1);
  g_syncs = 0;
  g_sync_fails = true;
  Recorder recorder(folder.file("run.mcap"), sample_info(RecordingLevel::roi), settings);
  for (int waited_ms = 0; g_syncs < 1 && waited_ms < 60'000; ++waited_ms) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  const RecordingOutcome outcome = recorder.close();
  g_sync_fails = false;
  EXPECT_FALSE(outcome.complete());
  EXPECT_NE(outcome.reason.find("Input/output error"), std::string::npos) << outcome.reason;
}

}  // namespace
}  // namespace glint
