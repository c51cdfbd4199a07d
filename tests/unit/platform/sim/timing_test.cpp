#include "platform/sim/timing.hpp"

#include <gtest/gtest.h>

#include <set>

#include "small_scene.hpp"

namespace glint::sim {
namespace {

constexpr Duration k_two_seconds = milliseconds(2000);

TimingSettings with(const FaultEvent& fault) {
  TimingSettings settings;
  settings.faults.push_back(fault);
  return settings;
}

TEST(Timing, KeepsTheCamerasPeriod) {
  const auto frames = frame_timings(small_camera(), {}, k_two_seconds, 1);
  ASSERT_EQ(frames.size(), 91u);  // 90 periods of 22.222222 ms are 20 ns less than 2 s
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_EQ(frames[i].sequence, i);
    EXPECT_EQ(frames[i].mid_exposure.nanoseconds, 22'222'222 * static_cast<std::int64_t>(i));
  }
}

TEST(Timing, ArrivesAfterExposureAndTransportWithJitter) {
  std::set<std::int64_t> delays;
  for (const FrameTiming& frame : frame_timings(small_camera(), {}, k_two_seconds, 1)) {
    const Duration delay = frame.arrival - frame.exposed;
    EXPECT_GE(delay, milliseconds(9));
    EXPECT_LT(delay, milliseconds(9) + microseconds(400));
    delays.insert(delay.nanoseconds);
  }
  EXPECT_GT(delays.size(), 80u);
}

TEST(Timing, FallsToFiveHertzAndComesBack) {
  TimingSettings settings;
  settings.slow.push_back({Time{500'000'000}, Time{1'500'000'000}});
  const auto frames = frame_timings(small_camera(), settings, k_two_seconds, 1);
  int slow = 0;
  for (std::size_t i = 1; i < frames.size(); ++i) {
    const Duration gap = frames[i].exposed - frames[i - 1].exposed;
    const bool inside = settings.slow.front().contains(frames[i - 1].exposed);
    EXPECT_EQ(gap, inside ? milliseconds(200) : Duration{22'222'222});
    slow += inside ? 1 : 0;
  }
  EXPECT_EQ(slow, 5);
}

TEST(Timing, DeliversADoubledFrameTwiceUnderOneNumber) {
  const auto frames = frame_timings(
      small_camera(), with({Fault::doubled, Time{990'000'000}, milliseconds(5)}), k_two_seconds, 1);
  ASSERT_EQ(frames.size(), 92u);
  EXPECT_EQ(frames[45].sequence, 45u);
  EXPECT_EQ(frames[46].sequence, 45u);
  EXPECT_EQ(frames[46].mid_exposure, frames[45].mid_exposure);
  EXPECT_EQ(frames[46].arrival - frames[45].arrival, milliseconds(5));
  EXPECT_EQ(frames[47].sequence, 46u);
}

TEST(Timing, LetsALateFrameArriveAfterItsSuccessors) {
  const auto frames = frame_timings(
      small_camera(), with({Fault::late, Time{990'000'000}, milliseconds(50)}), k_two_seconds, 1);
  ASSERT_EQ(frames.size(), 91u);
  EXPECT_EQ(frames[45].sequence, 46u);
  EXPECT_EQ(frames[46].sequence, 47u);
  EXPECT_EQ(frames[47].sequence, 45u);
  for (std::size_t i = 1; i < frames.size(); ++i) {
    EXPECT_LE(frames[i - 1].arrival, frames[i].arrival);
  }
}

TEST(Timing, StampsAFrameBackwardButExposesItInTime) {
  const auto frames = frame_timings(
      small_camera(), with({Fault::backward_stamp, Time{990'000'000}, milliseconds(100)}),
      k_two_seconds, 1);
  EXPECT_LT(frames[45].mid_exposure, frames[44].mid_exposure);
  EXPECT_GT(frames[45].exposed, frames[44].exposed);
  EXPECT_GT(frames[46].mid_exposure, frames[44].mid_exposure);
}

TEST(Timing, LosesADroppedFrame) {
  const auto frames = frame_timings(
      small_camera(), with({Fault::dropped, Time{990'000'000}, Duration{}}), k_two_seconds, 1);
  ASSERT_EQ(frames.size(), 90u);
  EXPECT_EQ(frames[44].sequence, 44u);
  EXPECT_EQ(frames[45].sequence, 46u);
}

}  // namespace
}  // namespace glint::sim
