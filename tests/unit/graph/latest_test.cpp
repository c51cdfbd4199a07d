#include "graph/latest.hpp"

#include <gtest/gtest.h>

namespace glint::graph::latest_test {
namespace {

TEST(TripleBuffer, IsEmptyWithVersionZeroBeforeAnythingIsPublished) {
  TripleBuffer<int> buffer;
  EXPECT_FALSE(buffer.sample());
  EXPECT_EQ(buffer.value(), 0);
  EXPECT_EQ(buffer.version(), 0u);
}

TEST(TripleBuffer, GivesTheNewestVersionAndItsTime) {
  TripleBuffer<int> buffer;
  for (int version = 1; version <= 5; ++version) {
    buffer.write_slot() = 10 * version;
    buffer.publish(static_cast<std::uint64_t>(version), 100 * version);
  }
  EXPECT_TRUE(buffer.sample());
  EXPECT_EQ(buffer.value(), 50);
  EXPECT_EQ(buffer.version(), 5u);
  EXPECT_EQ(buffer.time_ns(), 500);
}

TEST(TripleBuffer, HoldsWhatWasSampledWhileTheWriterGoesOn) {
  TripleBuffer<int> buffer;
  buffer.write_slot() = 1;
  buffer.publish(1, 0);
  ASSERT_TRUE(buffer.sample());
  for (int version = 2; version <= 7; ++version) {
    buffer.write_slot() = version;
    buffer.publish(static_cast<std::uint64_t>(version), 0);
    EXPECT_EQ(buffer.value(), 1);
  }
  buffer.write_slot() = 99;  // written, not published
  EXPECT_TRUE(buffer.sample());
  EXPECT_EQ(buffer.value(), 7);
  EXPECT_FALSE(buffer.sample()) << "nothing newer: stays with what it has";
  EXPECT_EQ(buffer.value(), 7);
}

TEST(Latest, TakesAConstantInPlaceOfABuffer) {
  Latest<int> latest;
  EXPECT_EQ(latest.version(), 0u);
  latest.set(5, 9, 70);
  EXPECT_FALSE(latest.sample());
  EXPECT_EQ(latest.value(), 5);
  EXPECT_EQ(latest.version(), 9u);
  EXPECT_EQ(latest.time_ns(), 70);
}

TEST(Latest, TakesAConstantInPlaceOfTheBufferItWasBoundTo) {
  TripleBuffer<int> buffer;
  buffer.write_slot() = 8;
  buffer.publish(3, 30);
  Latest<int> latest;
  latest.bind(buffer);
  ASSERT_TRUE(latest.sample());
  EXPECT_EQ(latest.value(), 8);
  latest.set(5, 9, 70);
  EXPECT_EQ(latest.value(), 5);
  EXPECT_EQ(latest.version(), 9u);
  EXPECT_EQ(latest.time_ns(), 70);
  EXPECT_FALSE(latest.sample());
}

}  // namespace
}  // namespace glint::graph::latest_test
