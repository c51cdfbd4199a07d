#include "kernels/wire/quantize.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace glint::quantize_test {
namespace {

constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();
constexpr double k_infinity = std::numeric_limits<double>::infinity();

std::int64_t rounded(double value) { return quantize(value, 1, -1000, 1000).value; }

TEST(Quantize, RoundsToTheNearestAndHalvesAwayFromZero) {
  EXPECT_EQ(rounded(0.5), 1);
  EXPECT_EQ(rounded(-0.5), -1);
  EXPECT_EQ(rounded(2.5), 3);
  EXPECT_EQ(rounded(-2.5), -3);
  EXPECT_EQ(rounded(2.4999999), 2);
  EXPECT_EQ(rounded(0.49999999999999994), 0);  // floor(x + 0.5) gives 1
  EXPECT_EQ(rounded(-0.0), 0);
}

TEST(Quantize, SaysWhatDoesNotFit) {
  EXPECT_TRUE(quantize(1000.4, 1, -1000, 1000).fits);
  EXPECT_FALSE(quantize(1000.6, 1, -1000, 1000).fits);
  EXPECT_TRUE(quantize(-1000.4, 1, -1000, 1000).fits);
  EXPECT_FALSE(quantize(-1000.6, 1, -1000, 1000).fits);
  for (const double bad : {k_nan, k_infinity, -k_infinity, 1e300, -1e300, 0x1p63, 0x1p64}) {
    EXPECT_FALSE(quantize(bad, 1, -1000, 1000).fits);
    EXPECT_EQ(quantize(bad, 1, -1000, 1000).value, 0);
    EXPECT_FALSE(quantize(bad, 1e9, -0x1FFFFFFFFFFFFF, 0x1FFFFFFFFFFFFF).fits);
  }
}

TEST(Quantize, GivesUpTheWholeVectorForOneOfItsParts) {
  const QuantizedVector good = quantize(Vector3(1, 2, 3), 10, -30, 30);
  EXPECT_TRUE(good.fits);
  EXPECT_EQ(good.value[2], 30);
  const QuantizedVector bad = quantize(Vector3(1, 2, 3.1), 10, -30, 30);
  EXPECT_FALSE(bad.fits);
  EXPECT_EQ(bad.value[0], 0);
}

TEST(Quantize, KeepsEachPartOfAVectorInItsPlace) {
  const QuantizedVector q = quantize(Vector3(-1, 2, 2.96), 10, -30, 30);
  EXPECT_TRUE(q.fits);
  EXPECT_EQ(q.value, (std::array<std::int64_t, 3>{-10, 20, 30}));
  for (int axis = 0; axis < 3; ++axis) {
    Vector3 one_beyond(1, 2, 3);
    one_beyond[axis] = -3.1;
    EXPECT_FALSE(quantize(one_beyond, 10, -30, 30).fits) << axis;
    EXPECT_EQ(quantize(one_beyond, 10, -30, 30).value, (std::array<std::int64_t, 3>{})) << axis;
  }
}

TEST(Quantize, PutsAllOnesWhereAnUncertaintyIsTooLarge) {
  EXPECT_EQ(quantize_or(10.22, 100, 1023), 1022U);
  EXPECT_EQ(quantize_or(10.23, 100, 1023), 1023U);
  EXPECT_EQ(quantize_or(-0.1, 100, 1023), 1023U);
  EXPECT_EQ(quantize_or(k_nan, 100, 1023), 1023U);
  EXPECT_EQ(quantize_or(1e300, 100, 1023), 1023U);
}

}  // namespace
}  // namespace glint::quantize_test
