#include "platform/apps/board/loop_source.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>
#include <filesystem>

#include "platform/runtime/rt/clock.hpp"

namespace glint::loop_source_test {
namespace {

constexpr int k_frames = 3;

// A loop of frames of one pixel; the second is a worst input.
class LoopSourceTest : public testing::Test {
 protected:
  LoopSourceTest()
      : file_(std::filesystem::temp_directory_path() /
              ("glint_source_" + std::to_string(::getpid()))) {
    FrameLoopHeader header;
    header.width = header.height = 1;
    header.frames = k_frames;
    header.period_ns = 1'000'000;
    FrameLoopWriter writer(file_, header);
    FrameBuffer pixels;
    pixels.width = pixels.height = 1;
    pixels.reflectivity_16 = {0};
    for (int i = 0; i < k_frames; ++i) {
      LoopFrame frame;
      frame.kind = i == 1 ? LoopFrameKind::worst : LoopFrameKind::rendered;
      writer.add(frame, pixels);
    }
    writer.close();
  }
  ~LoopSourceTest() override { std::filesystem::remove(file_); }

  std::string file_;
};

SourceClock live_from(Time epoch) {
  return {true, epoch, [epoch] { return Time{} + (monotonic_now() - epoch); }};
}

TEST_F(LoopSourceTest, LetsEveryFrameArriveOnceAndNoneBeforeItsTime) {
  const FrameLoop loop(file_);
  const Time epoch = monotonic_now();
  const Duration period = milliseconds(1);
  LoopSource source(loop, {20, period, milliseconds(5), 0, -1});
  source.start(live_from(epoch));
  ArrivedFrame arrived;
  for (int i = 0; i < 20; ++i) {
    ASSERT_TRUE(source.wait(arrived));
    const Time due = epoch + milliseconds(5) + period * i;
    EXPECT_GE(monotonic_now(), due);
    EXPECT_EQ(arrived.frame.arrival - Time{}, due - epoch);
    EXPECT_EQ(arrived.frame.sequence, static_cast<std::uint32_t>(i + 1));
    EXPECT_EQ(arrived.slot, static_cast<int>(loop.index_of(static_cast<std::uint64_t>(i))));
    source.release_pixels(arrived);
  }
  EXPECT_FALSE(source.wait(arrived));
  EXPECT_EQ(source.worst_frames_delivered(), 10);  // 0 1 2 1 0 1 2 1 ..
}

TEST_F(LoopSourceTest, KeepsFramesThatArriveWhileAnOlderOneIsWorkedOn) {
  const FrameLoop loop(file_);
  const Time epoch = monotonic_now();
  LoopSource source(loop, {5, milliseconds(1), {}, 0, -1});
  source.start(live_from(epoch));
  ArrivedFrame arrived;
  ASSERT_TRUE(source.wait(arrived));
  (void)sleep_until(epoch + milliseconds(10));
  for (int i = 1; i < 5; ++i) {
    ASSERT_TRUE(source.wait(arrived));
    EXPECT_EQ(arrived.frame.arrival, Time{} + milliseconds(1) * i);
  }
  EXPECT_FALSE(source.wait(arrived));
  EXPECT_LE(source.wake_ups_ns().size(), 1u);  // only the first frame found its group waiting
}

TEST_F(LoopSourceTest, GoesOnUntilItIsStoppedWhereNoNumberIsGiven) {
  const FrameLoop loop(file_);
  std::atomic<bool> stop{false};
  LoopSource source(loop, {0, milliseconds(1), {}, 0, -1, &stop});
  source.start(live_from(monotonic_now()));
  ArrivedFrame arrived;
  for (std::uint64_t i = 1; i <= 10; ++i) {
    ASSERT_TRUE(source.wait(arrived));
    ASSERT_EQ(arrived.frame.sequence, i);
  }
  stop = true;
  while (source.wait(arrived)) {  // frames that had arrived before the stop
  }
  EXPECT_GE(arrived.frame.sequence, 10u);
}

TEST_F(LoopSourceTest, InOrderWaitsForNoTimeAndGivesTheSameFrames) {
  const FrameLoop loop(file_);
  LoopSource source(loop, {4, milliseconds(3'600'000), milliseconds(7), 0, -1});
  source.start({false, Time{}, [] { return Time{}; }});
  ArrivedFrame arrived;
  for (int i = 0; i < 4; ++i) {
    ASSERT_TRUE(source.wait(arrived));
    EXPECT_EQ(arrived.frame.arrival, Time{} + milliseconds(7) + milliseconds(3'600'000) * i);
    EXPECT_EQ(arrived.slot, static_cast<int>(loop.index_of(static_cast<std::uint64_t>(i))));
  }
  EXPECT_FALSE(source.wait(arrived));
  EXPECT_EQ(source.frame_count(), 4u);
}

}  // namespace
}  // namespace glint::loop_source_test
