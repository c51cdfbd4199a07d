#include "platform/runtime/session/latency.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace glint {
namespace {

TEST(Latency, GivesNearestRankPercentilesOfEachPart) {
  std::vector<FrameToCan> entries;
  for (int i = 1; i <= 1000; ++i) {
    entries.push_back({microseconds(i), microseconds(2 * i), microseconds(1)});
  }
  const LatencyFigures computing = figures_of(entries, &FrameToCan::computing);
  EXPECT_EQ(computing.n, 1000);
  EXPECT_DOUBLE_EQ(computing.p50_us, 500);
  EXPECT_DOUBLE_EQ(computing.p99_us, 990);
  EXPECT_DOUBLE_EQ(computing.p99_9_us, 999);
  EXPECT_DOUBLE_EQ(computing.max_us, 1000);
  EXPECT_DOUBLE_EQ(figures_of_totals(entries).max_us, 3001);
}

TEST(Latency, IsAllZeroForNoFrames) {
  EXPECT_EQ(figures_of_totals({}).n, 0);
  EXPECT_EQ(figures_of_totals({}).max_us, 0);
}

TEST(Latency, LogKeepsTheNewestAndTheLargestInTheRoomOfTheStart) {
  LatencyLog log(3);
  const FrameToCan* const room = log.entries().data();
  for (const int ms : {1, 9, 2, 3, 4, 5, 6}) log.add({milliseconds(ms), {}, {}});
  ASSERT_EQ(log.entries().size(), 3u);
  EXPECT_EQ(log.entries().data(), room);
  EXPECT_EQ(log.overwritten(), 4);
  std::vector<std::int64_t> left;
  for (const FrameToCan& entry : log.entries()) left.push_back(entry.total().nanoseconds);
  std::sort(left.begin(), left.end());
  EXPECT_EQ(left, (std::vector<std::int64_t>{5'000'000, 6'000'000, 9'000'000}));
}

}  // namespace
}  // namespace glint
