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

// Every time field of a frame has a different value.
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

// A frame of 6 by 4 pixels: each plane in turn is missing, too wide or too high.
TEST(StampFrame, RefusesEachPlaneThatIsMissingOrOfAnotherSize) {
  const std::vector<std::uint8_t> bytes(7 * 5);
  const std::vector<std::uint16_t> words(7 * 5);
  for (const int bits : {8, 16}) {
    const auto frame_of = [&](int width, int height, int depth_width, int depth_height) {
      Frame frame;
      if (bits == 8) frame.reflectivity_8 = {bytes.data(), width, height};
      if (bits == 16) frame.reflectivity_16 = {words.data(), width, height};
      frame.depth = {words.data(), depth_width, depth_height};
      return frame;
    };
    StampFrame node{6, 4, bits};
    const auto reason_of = [&](const Frame& frame) {
      FrameStamp stamp;
      node(frame, stamp);
      return stamp.reason;
    };
    EXPECT_EQ(reason_of(frame_of(6, 4, 6, 4)), Reason::none) << bits;
    EXPECT_EQ(reason_of(frame_of(7, 4, 6, 4)), Reason::frame_invalid) << bits;
    EXPECT_EQ(reason_of(frame_of(6, 5, 6, 4)), Reason::frame_invalid) << bits;
    EXPECT_EQ(reason_of(frame_of(6, 4, 7, 4)), Reason::frame_invalid) << bits;
    EXPECT_EQ(reason_of(frame_of(6, 4, 6, 5)), Reason::frame_invalid) << bits;
    Frame bare = frame_of(6, 4, 6, 4);
    bare.depth.pixels = nullptr;
    EXPECT_EQ(reason_of(bare), Reason::frame_invalid) << bits;
    node.reflectivity_bits = 24 - bits;
    EXPECT_EQ(reason_of(frame_of(6, 4, 6, 4)), Reason::frame_invalid) << "the other plane's bits";
  }
}

// Each frame increments one counter by one. Its verdict holds its time stamp.
TEST(CheckFrame, CountsEachFrameOnceAndStatesItsStamp) {
  CheckFrame node;
  FrameStamp stamp = stamp_at(100, 7);
  stamp.sigma = {5};
  FrameVerdict verdict = check(node, stamp);
  EXPECT_EQ(verdict.stamp.mid_exposure, stamp.mid_exposure);
  EXPECT_EQ(verdict.stamp.arrival, stamp.arrival);
  EXPECT_EQ(verdict.stamp.sigma, stamp.sigma);
  EXPECT_EQ(verdict.stamp.sequence, 7U);
  const auto expect = [&](std::uint64_t accepted, std::uint64_t late, std::uint64_t doubled,
                          std::uint64_t invalid) {
    EXPECT_EQ(verdict.accepted, accepted);
    EXPECT_EQ(verdict.late, late);
    EXPECT_EQ(verdict.doubled, doubled);
    EXPECT_EQ(verdict.invalid, invalid);
    EXPECT_EQ(verdict.resynchronisations, 0U);
    EXPECT_FALSE(verdict.resynchronised);
  };
  expect(1, 0, 0, 0);
  verdict = check(node, stamp_at(90, 6));
  EXPECT_EQ(verdict.stamp.sequence, 6U) << "also of a frame that is refused";
  expect(1, 1, 0, 0);
  verdict = check(node, stamp_at(122, 7));
  expect(1, 1, 1, 0);
  stamp = stamp_at(122, 8);
  stamp.reason = Reason::frame_invalid;
  verdict = check(node, stamp);
  EXPECT_EQ(verdict.reason, Reason::frame_invalid);
  expect(1, 1, 1, 1);
  stamp = stamp_at(122, 8);
  stamp.arrival = stamp.mid_exposure;
  verdict = check(node, stamp);
  EXPECT_TRUE(verdict.usable()) << "exposed as it arrived";
  expect(2, 1, 1, 1);
  EXPECT_EQ(node.counts(), (graph::LoopCounts{{1}}));
}

// The node compares a frame with the last accepted frame, not with a rejected one.
TEST(CheckFrame, ComparesWithTheNewestAcceptedFrame) {
  CheckFrame node;
  (void)check(node, stamp_at(100, 7));
  (void)check(node, stamp_at(90, 3));
  EXPECT_EQ(check(node, stamp_at(90, 3)).reason, Reason::frame_late) << "no frame was doubled";
  EXPECT_EQ(check(node, stamp_at(100, 8)).reason, Reason::frame_duplicate);
  FrameStamp invalid = stamp_at(200, 9);
  invalid.reason = Reason::frame_invalid;
  (void)check(node, invalid);
  EXPECT_TRUE(check(node, stamp_at(122, 8)).usable());
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
  EXPECT_EQ(check(node, stamp_at(0, 1)).reason, Reason::frame_duplicate);
  EXPECT_EQ(check(node, stamp_at(22, 0)).reason, Reason::frame_duplicate);
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

TEST(CheckFrame, CountsAResynchronisationAndGoesOnByTheNewClock) {
  CheckFrame node;
  (void)check(node, stamp_at(1000, 50));
  FrameVerdict verdict;
  for (int i = 1; i <= k_resync_frames; ++i) {
    verdict = check(node, stamp_at(22 * i, static_cast<std::uint32_t>(i)));
    EXPECT_EQ(verdict.resynchronised, i == k_resync_frames) << i;
  }
  EXPECT_EQ(verdict.accepted, 2U);
  EXPECT_EQ(verdict.late, static_cast<std::uint64_t>(k_resync_frames - 1));
  EXPECT_EQ(verdict.resynchronisations, 1U);
  const std::int64_t now_ms = 22 * k_resync_frames;
  EXPECT_EQ(check(node, stamp_at(now_ms, 77)).reason, Reason::frame_duplicate);
  EXPECT_EQ(check(node, stamp_at(now_ms - 1, 78)).reason, Reason::frame_late);
  verdict = check(node, stamp_at(now_ms + 1, 50));
  EXPECT_TRUE(verdict.usable()) << "the old clock's sequence numbers are gone, too";
  EXPECT_FALSE(verdict.resynchronised);
}

// Requires k_resync_frames (8) successive rejected frames with increasing stamps. An accepted
// frame, or a stamp that does not increase, restarts the count.
TEST(CheckFrame, NeedsAWholeRowOfAdvancingFramesToBelieveAClock) {
  CheckFrame node;
  (void)check(node, stamp_at(1000, 1));
  std::uint32_t sequence = 2;
  const auto refused = [&](std::int64_t ms) {
    return !check(node, stamp_at(ms, sequence++)).usable();
  };
  for (int i = 0; i < k_resync_frames - 1; ++i) EXPECT_TRUE(refused(100 + i)) << i;
  EXPECT_FALSE(refused(1022)) << "the old clock goes on";
  for (int i = 0; i < k_resync_frames - 1; ++i) EXPECT_TRUE(refused(200 + i)) << i;
  EXPECT_TRUE(refused(50)) << "the first of another row";
  EXPECT_TRUE(refused(50)) << "and again: it does not advance";
  for (int i = 1; i < k_resync_frames - 1; ++i) EXPECT_TRUE(refused(50 + i)) << i;
  EXPECT_FALSE(refused(50 + k_resync_frames));
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
