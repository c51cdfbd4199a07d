#include "kernels/wire/smallest_three.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace glint::smallest_three_test {
namespace {

double degrees_between(const Quaternion& a, const Quaternion& b) {
  const double half = (a.conjugate() * b).vec().norm();
  return 2 * std::asin(std::min(1.0, half)) * 180 / 3.141592653589793;
}

TEST(SmallestThree, ComesBackWithinFourThousandthsOfADegree) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  double worst = 0;
  for (int i = 0; i < 200000; ++i) {
    Quaternion q(normal(random), normal(random), normal(random), normal(random));
    q.normalize();
    const SmallestThree packed = to_smallest_three(q);
    ASSERT_TRUE(packed.valid);
    worst = std::max(worst, degrees_between(q, from_smallest_three(packed)));
  }
  EXPECT_LT(worst, 0.0038);
  EXPECT_GT(worst, 0.002);  // a smaller value means that the test measures wrongly
}

TEST(SmallestThree, LeavesOutTheLargestAndMakesItPositive) {
  const Quaternion q(0.1, 0.1, -0.98488578017961, 0.1);  // w, x, y, z: unit
  const SmallestThree packed = to_smallest_three(q);
  ASSERT_TRUE(packed.valid);
  EXPECT_EQ(packed.left_out, 1);
  for (const std::int16_t part : packed.component) EXPECT_EQ(part, -4634);  // 0.1 / 2.1580187e-5
  EXPECT_LT(degrees_between(q, from_smallest_three(packed)), 0.004);
}

TEST(SmallestThree, TakesTheFirstOfEqualComponents) {
  const double half = std::sqrt(0.5);
  EXPECT_EQ(to_smallest_three(Quaternion(half, 0, 0, half)).left_out, 2);
  EXPECT_EQ(to_smallest_three(Quaternion(half, half, 0, 0)).left_out, 0);
  EXPECT_EQ(to_smallest_three(Quaternion(half, half, 0, 0)).component[2], 32766);
}

TEST(SmallestThree, RefusesWhatIsNoRotation) {
  EXPECT_FALSE(to_smallest_three(Quaternion(0, 0, 0, 0)).valid);
  EXPECT_FALSE(to_smallest_three(Quaternion(1.01, 0, 0, 0)).valid);
  EXPECT_FALSE(
      to_smallest_three(Quaternion(std::numeric_limits<double>::quiet_NaN(), 0, 0, 1)).valid);
}

// to_smallest_three() normalises a quaternion whose length is within 1e-3 of one.
TEST(SmallestThree, TakesAQuaternionOfAlmostUnitLengthAsOfUnitLength) {
  const Quaternion unit = Quaternion(0.3, -0.2, 0.8, 0.4).normalized();
  const SmallestThree expected = to_smallest_three(unit);
  for (const double length : {0.9991, 1.0009, 0.9989, 1.0011}) {
    const Quaternion q(Eigen::Vector4d(length * unit.coeffs()));
    const SmallestThree packed = to_smallest_three(q);
    EXPECT_EQ(packed.valid, std::abs(length - 1) < 1e-3) << length;
    if (!packed.valid) continue;
    EXPECT_EQ(packed.left_out, expected.left_out);
    EXPECT_EQ(packed.component, expected.component) << length;
  }
}

// The largest component is the omitted one: each index of it, with either sign.
TEST(SmallestThree, GivesBackTheLargestComponentAtEachPlace) {
  for (int index = 0; index < 4; ++index) {
    for (const double sign : {1.0, -1.0}) {
      Eigen::Vector4d parts(0.1, -0.2, 0.3, -0.4);  // x, y, z, w
      parts[index] = sign * 0.9;
      parts.normalize();
      const SmallestThree packed = to_smallest_three(Quaternion(parts));
      EXPECT_EQ(packed.left_out, index);
      const Eigen::Vector4d back = from_smallest_three(packed).coeffs();
      EXPECT_LT((back - sign * parts).cwiseAbs().maxCoeff(), 3 * k_smallest_three_step) << index;
      EXPECT_GT(back[index], 0);
    }
  }
}

TEST(SmallestThree, GivesAUnitQuaternionForAnyIntegers) {
  SmallestThree packed;
  for (const std::int16_t value : {INT16_MIN, INT16_MAX, 0}) {
    packed.component.fill(static_cast<std::int16_t>(value));
    EXPECT_NEAR(from_smallest_three(packed).norm(), 1, 1e-12);
  }
}

}  // namespace
}  // namespace glint::smallest_three_test
