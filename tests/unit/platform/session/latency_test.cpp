#include "platform/session/latency.hpp"

#include <gtest/gtest.h>

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

TEST(Latency, CountsWhatDoesNotFitInsteadOfAllocating) {
  LatencyLog log(2);
  for (int i = 0; i < 5; ++i) log.add({});
  EXPECT_EQ(log.entries().size(), 2u);
  EXPECT_EQ(log.beyond(), 3);
}

}  // namespace
}  // namespace glint
