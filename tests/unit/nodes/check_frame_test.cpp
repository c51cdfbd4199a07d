#include "nodes/check_frame.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace glint {
namespace {

FrameStamp stamp_at(std::int64_t ms, std::uint32_t sequence) {
  FrameStamp stamp;
  stamp.mid_exposure = Time{} + milliseconds(ms);
  stamp.arrival = stamp.mid_exposure + milliseconds(10);
  stamp.sequence = sequence;
  return stamp;
}

FrameVerdict check(CheckFrame& node, const FrameStamp& stamp) {
  FrameVerdict verdict;
  node(stamp, verdict);
  return verdict;
}

// All that a frame states of its time, each field another.
TEST(StampFrame, TakesTheStampOffAFrame) {
  const std::vector<std::uint16_t> pixels(6 * 4);
  Frame frame;
  frame.reflectivity_16 = {pixels.data(), 6, 4};
  frame.depth = {pixels.data(), 6, 4};
  frame.mid_exposure = {11};
  frame.stamp_sigma = {22};
  frame.arrival = {33};
  frame.sequence = 44;
  StampFrame node;
  node.width = 6;
  node.height = 4;
  FrameStamp stamp;
  node(frame, stamp);
  EXPECT_EQ(stamp.reason, Reason::none);
  EXPECT_EQ(stamp.mid_exposure.nanoseconds, 11);
  EXPECT_EQ(stamp.sigma.nanoseconds, 22);
  EXPECT_EQ(stamp.arrival.nanoseconds, 33);
  EXPECT_EQ(stamp.sequence, 44u);
  node.height = 5;
  node(frame, stamp);
  EXPECT_EQ(stamp.reason, Reason::frame_invalid);
}

TEST(CheckFrame, AcceptsFramesInOrder) {
  CheckFrame node;
  for (int i = 0; i < 100; ++i) {
    EXPECT_TRUE(check(node, stamp_at(22 * i, static_cast<std::uint32_t>(i))).usable());
  }
  EXPECT_EQ(check(node, stamp_at(3000, 100)).accepted, 101u);
}

TEST(CheckFrame, CountsADoubledFrameByStampOrBySequence) {
  CheckFrame node;
  (void)check(node, stamp_at(0, 0));
  EXPECT_EQ(check(node, stamp_at(0, 1)).reason, Reason::frame_doubled);
  EXPECT_EQ(check(node, stamp_at(22, 0)).reason, Reason::frame_doubled);
  EXPECT_EQ(check(node, stamp_at(22, 1)).doubled, 2u);
}

TEST(CheckFrame, RefusesALateFrameAndGoesOn) {
  CheckFrame node;
  (void)check(node, stamp_at(0, 0));
  (void)check(node, stamp_at(44, 2));
  EXPECT_EQ(check(node, stamp_at(22, 1)).reason, Reason::frame_late);
  const FrameVerdict next = check(node, stamp_at(66, 3));
  EXPECT_TRUE(next.usable());
  EXPECT_EQ(next.late, 1u);
}

TEST(CheckFrame, RefusesAFrameExposedAfterItsArrival) {
  CheckFrame node;
  FrameStamp stamp = stamp_at(0, 0);
  stamp.arrival = stamp.mid_exposure - microseconds(1);
  EXPECT_EQ(check(node, stamp).reason, Reason::frame_invalid);
}

TEST(CheckFrame, BelievesAClockThatRestartedAfterEightFrames) {
  CheckFrame node;
  (void)check(node, stamp_at(1000, 50));
  for (int i = 0; i < k_resync_frames - 1; ++i) {
    EXPECT_EQ(check(node, stamp_at(22 * i, static_cast<std::uint32_t>(i))).reason,
              Reason::frame_late);
  }
  const FrameVerdict verdict = check(node, stamp_at(500, 40));
  EXPECT_TRUE(verdict.usable());
  EXPECT_TRUE(verdict.resynchronised);
  EXPECT_TRUE(check(node, stamp_at(522, 41)).usable());
}

TEST(CheckFrame, NeverBelievesLateFramesThatDoNotAdvance) {
  CheckFrame node;
  (void)check(node, stamp_at(1000, 50));
  for (int i = 0; i < 100; ++i) {
    EXPECT_FALSE(check(node, stamp_at(900 - i, static_cast<std::uint32_t>(i))).usable());
  }
}

TEST(StampFrame, RefusesAFrameOfTheWrongSizeOrWithoutDepth) {
  std::array<std::uint16_t, 16> pixels{};
  Frame frame;
  frame.reflectivity_16 = {pixels.data(), 4, 4};
  frame.depth = {pixels.data(), 4, 4};
  StampFrame node{4, 4, 16};
  FrameStamp stamp;
  node(frame, stamp);
  EXPECT_EQ(stamp.reason, Reason::none);
  frame.depth = {};
  node(frame, stamp);
  EXPECT_EQ(stamp.reason, Reason::frame_invalid);
  frame.depth = {pixels.data(), 4, 4};
  node.width = 5;
  node(frame, stamp);
  EXPECT_EQ(stamp.reason, Reason::frame_invalid);
}

}  // namespace
}  // namespace glint
