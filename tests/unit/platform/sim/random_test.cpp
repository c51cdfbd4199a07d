#include "platform/sim/random.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace glint::sim {
namespace {

TEST(Random, HasTheBitsThatItHadWhenThisWasWritten) {
  const RandomKey key{1, Stream::blob, 2};
  EXPECT_EQ(key.bits(0), 11206379135287559286u);
  EXPECT_EQ(gaussian(key, 7), 0x1.012c4aaa65817p+0);
}

TEST(Random, IsUniformWithinItsOpenInterval) {
  const RandomKey key{5, Stream::room};
  double sum = 0, squares = 0;
  constexpr int n = 20000;
  for (std::uint64_t i = 0; i < n; ++i) {
    const double u = uniform(key, i);
    ASSERT_GT(u, 0);
    ASSERT_LT(u, 1);
    sum += u;
    squares += u * u;
  }
  EXPECT_NEAR(sum / n, 0.5, 0.008);
  EXPECT_NEAR(squares / n, 1.0 / 3, 0.008);
}

TEST(Random, IsNormal) {
  const RandomKey key{6, Stream::blob};
  constexpr int n = 40000;
  double sum = 0, squares = 0, fourth = 0;
  for (std::uint64_t i = 0; i < n; ++i) {
    const double g = gaussian(key, i);
    sum += g;
    squares += g * g;
    fourth += g * g * g * g;
  }
  EXPECT_NEAR(sum / n, 0, 0.02);
  EXPECT_NEAR(squares / n, 1, 0.03);
  EXPECT_NEAR(fourth / n, 3, 0.2);
}

TEST(Random, DiffersBySeedStreamInstanceAndIndex) {
  const RandomKey key{1, Stream::hand, 0};
  EXPECT_NE(key.bits(3), (RandomKey{2, Stream::hand, 0}).bits(3));
  EXPECT_NE(key.bits(3), (RandomKey{1, Stream::head, 0}).bits(3));
  EXPECT_NE(key.bits(3), (RandomKey{1, Stream::hand, 1}).bits(3));
  EXPECT_NE(key.bits(3), key.bits(4));
}

TEST(Random, StreamsAreNotCorrelated) {
  const RandomKey a{1, Stream::blob, 0}, b{1, Stream::blob, 1};
  constexpr int n = 20000;
  double neighbours = 0, across = 0;
  for (std::uint64_t i = 0; i < n; ++i) {
    neighbours += gaussian(a, i) * gaussian(a, i + 1);
    across += gaussian(a, i) * gaussian(b, i);
  }
  EXPECT_NEAR(neighbours / n, 0, 0.03);
  EXPECT_NEAR(across / n, 0, 0.03);
}

}  // namespace
}  // namespace glint::sim
