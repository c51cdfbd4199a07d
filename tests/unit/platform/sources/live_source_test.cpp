// Slots of a live source: the oldest waiting frame is dropped when all are used.
#include "platform/sources/live_source.hpp"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

#include "platform/runtime/rt/clock.hpp"

namespace glint {
namespace {

class LiveSourceTest : public testing::Test {
 protected:
  LiveSourceTest() : live_(hololens2_ahat(), {}) {
    live_.start({true, begin_ - milliseconds(1000), [] { return monotonic_now(); }});
  }
  // Frame `number` holds its number in its first pixel.
  void produce(int number) {
    const Time stamp = Time{} + milliseconds(22) * (number + 1);
    const Time arrival = begin_ + milliseconds(22) * (number + 1);
    const std::optional<Time> exposure = live_.exposure_of(stamp, arrival);
    ASSERT_TRUE(exposure) << "frame " << number;
    LiveSource::Slot* const slot = live_.slot_for_next();
    ASSERT_NE(slot, nullptr) << "frame " << number;
    slot->pixels.depth[0] = static_cast<std::uint16_t>(number);
    live_.publish(*exposure, arrival, {});
  }
  int number_of(const ArrivedFrame& arrived) { return arrived.frame.depth.pixels[0]; }
  int consume() {
    ArrivedFrame arrived;
    EXPECT_TRUE(live_.wait(arrived));
    const int number = number_of(arrived);
    live_.release_pixels(arrived);
    return number;
  }
  std::uint64_t dropped() {
    SourceReport report;
    live_.add_to(report);
    return report.counts.front().second;
  }

  Time begin_ = monotonic_now();
  LiveSource live_;
};

TEST_F(LiveSourceTest, DropsTheOldestOfElevenFrames) {
  for (int i = 0; i < 11; ++i) produce(i);
  EXPECT_EQ(dropped(), 3u);
  std::vector<int> numbers;
  for (int i = 0; i < 8; ++i) numbers.push_back(consume());
  EXPECT_EQ(numbers, (std::vector{3, 4, 5, 6, 7, 8, 9, 10}));
}

TEST_F(LiveSourceTest, NeverDropsTheFrameInUse) {
  produce(0);
  ArrivedFrame in_use;
  ASSERT_TRUE(live_.wait(in_use));
  for (int i = 1; i < 20; ++i) {
    produce(i);
    EXPECT_EQ(number_of(in_use), 0) << "after frame " << i;
  }
  EXPECT_EQ(dropped(), 12u);  // seven of 19 wait
  live_.release_pixels(in_use);
  for (int i = 13; i < 20; ++i) EXPECT_EQ(consume(), i);
  EXPECT_EQ(in_use.frame.sequence, 0u);
}

TEST_F(LiveSourceTest, ReceivesRisingFramesFromAnotherThread) {
  constexpr int k_frames = 2000;
  std::thread producer([&] {
    for (int i = 0; i < k_frames; ++i) produce(i);
  });
  int newest = -1, received = 0;
  while (newest < k_frames - 1) {
    const int number = consume();
    EXPECT_GT(number, newest);
    newest = number;
    ++received;
  }
  producer.join();
  EXPECT_EQ(static_cast<std::uint64_t>(received) + dropped(), std::uint64_t{k_frames});
}

}  // namespace
}  // namespace glint
