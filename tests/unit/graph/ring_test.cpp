#include "graph/ring.hpp"

#include <gtest/gtest.h>

namespace glint::graph::ring_test {
namespace {

TEST(Ring, GivesItemsInTheOrderTheyCame) {
  Ring<int, 4> ring;
  int item = -1;
  EXPECT_FALSE(ring.pop(item));
  EXPECT_EQ(item, -1);
  for (int round = 0; round < 10; ++round) {
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(ring.push(10 * round + i));
    for (int i = 0; i < 3; ++i) {
      ASSERT_TRUE(ring.pop(item));
      EXPECT_EQ(item, 10 * round + i);
    }
  }
  EXPECT_EQ(ring.dropped(), 0u);
  EXPECT_EQ(ring.capacity(), 4);
}

TEST(Ring, DropsAndCountsWhatFindsNoRoomAndKeepsWhatItHas) {
  Ring<int, 4> ring;
  for (int i = 0; i < 7; ++i) EXPECT_EQ(ring.push(i), i < 4);
  EXPECT_EQ(ring.dropped(), 3u);
  int item = -1;
  for (int i = 0; i < 4; ++i) {
    ASSERT_TRUE(ring.pop(item));
    EXPECT_EQ(item, i);
  }
  EXPECT_FALSE(ring.pop(item));
  EXPECT_TRUE(ring.push(8));
}

TEST(Ring, CountsOnPastTheEndOfItsCounters) {
  RingIndex<4> index(0xFFFF'FFFE);
  for (int i = 0; i < 4; ++i) {
    ASSERT_TRUE(index.has_room());
    EXPECT_EQ(index.push_slot(), (i + 2) % 4);
    index.push();
  }
  EXPECT_FALSE(index.has_room());
  for (int i = 0; i < 4; ++i) {
    ASSERT_TRUE(index.has_item());
    EXPECT_EQ(index.pop_slot(), (i + 2) % 4);
    index.pop();
  }
  EXPECT_FALSE(index.has_item());
  EXPECT_TRUE(index.has_room());
}

}  // namespace
}  // namespace glint::graph::ring_test
