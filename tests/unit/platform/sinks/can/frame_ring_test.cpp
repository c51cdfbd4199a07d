#include "platform/sinks/can/frame_ring.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <thread>

namespace glint::frame_ring_test {
namespace {

StampedFrame numbered(std::uint32_t number) {
  StampedFrame item;
  item.frame.identifier = number;
  item.time = {number};
  return item;
}

TEST(FrameRing, TakesItsCapacityAndNoMore) {
  const auto ring = std::make_unique<FrameRing>();
  for (int round = 0; round < 3; ++round) {
    for (std::uint32_t i = 0; i < FrameRing::k_capacity; ++i) ASSERT_TRUE(ring->push(numbered(i)));
    EXPECT_FALSE(ring->push(numbered(0)));
    for (std::uint32_t i = 0; i < FrameRing::k_capacity; ++i)
      ASSERT_EQ(ring->pop()->frame.identifier, i);
    EXPECT_FALSE(ring->pop());
  }
  EXPECT_EQ(ring->pushed(), 3 * FrameRing::k_capacity);
}

TEST(FrameRing, KeepsOrderAndContentBetweenTwoThreads) {
  constexpr std::uint32_t k_count = 100000;
  const auto ring = std::make_unique<FrameRing>();
  std::thread pusher([&ring] {
    for (std::uint32_t i = 0; i < k_count;) {
      if (ring->push(numbered(i)))
        ++i;
      else
        std::this_thread::yield();
    }
  });
  std::uint32_t wrong = 0;
  for (std::uint32_t next = 0; next < k_count;) {
    const auto item = ring->pop();
    if (!item) {
      std::this_thread::yield();
      continue;
    }
    if (item->frame.identifier != next || item->time.nanoseconds != next) ++wrong;
    ++next;
  }
  pusher.join();
  EXPECT_EQ(wrong, 0U);
  EXPECT_FALSE(ring->pop());
}

}  // namespace
}  // namespace glint::frame_ring_test
