#include "kernels/pose/depth_bias.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace glint {
namespace {

constexpr DepthBias k_bias{0.003, 0.01, 0.002, 0.3, 0.8};

TEST(DepthBias, IsNothingWhereNothingWasMeasured) {
  EXPECT_EQ(DepthBias{}.at(0.5, 1000), 0);
  EXPECT_EQ((DepthBias{0.003, 0.01, 0.002, 0, 0}.at(0.5, 1000)), 0);
}

TEST(DepthBias, FollowsRangeAndBrightness) {
  EXPECT_DOUBLE_EQ(k_bias.at(0.5, 1000), 0.005);
  EXPECT_DOUBLE_EQ(k_bias.at(0.7, 1000), 0.007);
  EXPECT_DOUBLE_EQ(k_bias.at(0.5, 500), 0.007);
  EXPECT_DOUBLE_EQ(k_bias.at(0.5, 40'000), 0.003 + 0.00005);
}

TEST(DepthBias, StaysAsItIsBeyondTheRangesItWasMeasuredAt) {
  EXPECT_EQ(k_bias.at(1.5, 1000), k_bias.at(0.8, 1000));
  EXPECT_EQ(k_bias.at(0.1, 1000), k_bias.at(0.3, 1000));
}

TEST(DepthBias, IsANumberForAnyMarker) {
  for (const double range : {0.0, 1e9, std::numeric_limits<double>::infinity()}) {
    for (const std::uint16_t peak : {0, 1, 65535}) {
      EXPECT_TRUE(std::isfinite(k_bias.at(range, peak)));
    }
  }
}

}  // namespace
}  // namespace glint
