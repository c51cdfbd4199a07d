#include "platform/sinks/dds/latency_histogram.hpp"

#include <gtest/gtest.h>

namespace glint {
namespace {

TEST(LatencyHistograms, GiveQuantilesToTenMicroseconds) {
  LatencyHistogram histogram;
  for (int i = 1; i <= 1000; ++i) histogram.add(microseconds(i));
  EXPECT_NEAR(histogram.quantile_us(0.5), 500, 10);
  EXPECT_NEAR(histogram.quantile_us(0.99), 990, 10);
  EXPECT_DOUBLE_EQ(histogram.max_us(), 1000);
}

TEST(LatencyHistograms, KeepTheMaximumExactBeyondTheLastBucket) {
  LatencyHistogram histogram;
  histogram.add(milliseconds(-5));
  histogram.add(milliseconds(5000));
  EXPECT_DOUBLE_EQ(histogram.max_us(), 5e6);
  EXPECT_LE(histogram.quantile_us(0.5), 10);
}

TEST(LatencyHistograms, AreZeroWhenEmpty) { EXPECT_EQ(LatencyHistogram{}.quantile_us(0.99), 0); }

}  // namespace
}  // namespace glint
