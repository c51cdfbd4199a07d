#include "kernels/elementary.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/unit/kernels/pose/scene.hpp"

namespace glint {
namespace {

constexpr int k_trials = 100'000;
constexpr double k_infinity = std::numeric_limits<double>::infinity();
constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();

double units_in_last_place(double found, double expected) {
  const double size = std::abs(expected);
  return std::abs(found - expected) / (std::nextafter(size, k_infinity) - size);
}

// A magnitude from 10^low to 10^high, of either sign.
double of_any_size(test::Random& random, double low, double high) {
  const double size = std::pow(10.0, random.within(low, high));
  return random.below(2) == 0 ? size : -size;
}

TEST(Elementary, SineAndCosineAgreeWithTheLibraryOverTheirWholeRange) {
  test::Random random(1);
  double worst = 0;
  for (int i = 0; i < k_trials; ++i) {
    const double x = of_any_size(random, -8, 5);
    const SineCosine found = sine_cosine(x);
    worst = std::max({worst, units_in_last_place(found.sine, std::sin(x)),
                      units_in_last_place(found.cosine, std::cos(x))});
  }
  EXPECT_LE(worst, 2.0);
}

TEST(Elementary, SineKeepsItsDigitsNextToMultiplesOfPi) {
  for (int turns = 1; turns < 31'000; turns += 7) {
    const double x = turns * 3.141592653589793;
    EXPECT_NEAR(sine_cosine(x).sine, std::sin(x), 1e-9 * std::abs(std::sin(x))) << turns;
  }
}

TEST(Elementary, LogarithmAgreesWithTheLibraryFromTheSmallestToTheLargest) {
  test::Random random(2);
  double worst = 0;
  for (int i = 0; i < k_trials; ++i) {
    const double wide = std::pow(10.0, random.within(-307, 308));
    const double near_one = random.within(0.5, 2.0);
    worst = std::max({worst, units_in_last_place(logarithm(wide), std::log(wide)),
                      units_in_last_place(logarithm(near_one), std::log(near_one))});
  }
  EXPECT_LE(worst, 2.0);
  EXPECT_EQ(logarithm(1.0), 0.0);
  EXPECT_NEAR(logarithm(5e-324), -744.4400719213812, 1e-12);
}

TEST(Elementary, ExponentialAgreesWithTheLibrary) {
  test::Random random(3);
  double worst = 0;
  for (int i = 0; i < k_trials; ++i) {
    const double x = random.within(-700, 700);
    const double small = random.within(-1, 1);
    worst = std::max({worst, units_in_last_place(exponential(x), std::exp(x)),
                      units_in_last_place(exponential(small), std::exp(small))});
  }
  EXPECT_LE(worst, 2.0);
  EXPECT_EQ(exponential(0.0), 1.0);
}

TEST(Elementary, ArcTangentAgreesWithTheLibraryInAllQuadrants) {
  test::Random random(4);
  double worst = 0;
  for (int i = 0; i < k_trials; ++i) {
    const double y = of_any_size(random, -5, 5);
    const double x = of_any_size(random, -5, 5);
    worst = std::max(worst, units_in_last_place(arc_tangent(y, x), std::atan2(y, x)));
  }
  EXPECT_LE(worst, 2.0);
  for (const double y : {0.0, -0.0, 1.0, -1.0}) {
    for (const double x : {0.0, -0.0, 1.0, -1.0}) {
      if (y == 0 && x == 0) continue;
      EXPECT_EQ(arc_tangent(y, x), std::atan2(y, x)) << y << " " << x;
    }
  }
  EXPECT_EQ(arc_tangent(0.0, 0.0), 0.0);
}

TEST(Elementary, ArcCosineAgreesWithTheLibraryAlsoNextToOne) {
  test::Random random(5);
  double worst = 0;
  for (int i = 0; i < k_trials; ++i) {
    const double x = random.within(-1, 1);
    const double near_one = 1.0 - std::pow(10.0, random.within(-15, 0));
    worst = std::max({worst, units_in_last_place(arc_cosine(x), std::acos(x)),
                      units_in_last_place(arc_cosine(near_one), std::acos(near_one))});
  }
  EXPECT_LE(worst, 4.0);
}

TEST(Elementary, NeverAnswersWithANumberThatIsNotFinite) {
  for (const double x : {k_nan, -k_nan, k_infinity, -k_infinity, 1e300, -1e300, 0.0, 5e-324}) {
    EXPECT_TRUE(std::isfinite(sine_cosine(x).sine)) << x;
    EXPECT_TRUE(std::isfinite(sine_cosine(x).cosine)) << x;
    EXPECT_TRUE(std::isfinite(logarithm(x))) << x;
    EXPECT_TRUE(std::isfinite(exponential(x))) << x;
    EXPECT_TRUE(std::isfinite(arc_cosine(x))) << x;
    for (const double y : {k_nan, k_infinity, -k_infinity, 1.0}) {
      EXPECT_TRUE(std::isfinite(arc_tangent(y, x))) << y << " " << x;
    }
  }
}

// A value outside the range counts as the range's end, NaN as zero.
TEST(Elementary, ClampsItsArguments) {
  for (const double sign : {1.0, -1.0}) {
    for (const double beyond : {1e5 + 0.75, 1e6, k_infinity}) {
      EXPECT_EQ(sine_cosine(sign * beyond).sine, sine_cosine(sign * 1e5).sine) << beyond;
      EXPECT_EQ(sine_cosine(sign * beyond).cosine, sine_cosine(sign * 1e5).cosine) << beyond;
    }
    EXPECT_NEAR(sine_cosine(sign * 1e5).sine, std::sin(sign * 1e5), 1e-15);
    for (const double beyond : {700.5, 1e4, k_infinity})
      EXPECT_EQ(exponential(sign * beyond), exponential(sign * 700)) << beyond;
    EXPECT_LE(units_in_last_place(exponential(sign * 700), std::exp(sign * 700)), 2.0);
    for (const double beyond : {1 + 1e-15, 1.5, k_infinity})
      EXPECT_EQ(arc_cosine(sign * beyond), arc_cosine(sign)) << beyond;
  }
  EXPECT_EQ(arc_cosine(1), 0);
  EXPECT_DOUBLE_EQ(arc_cosine(-1), std::acos(-1.0));
  EXPECT_EQ(sine_cosine(k_nan).sine, 0);
  EXPECT_EQ(sine_cosine(k_nan).cosine, 1);
  EXPECT_EQ(exponential(k_nan), 1);
  EXPECT_EQ(arc_cosine(k_nan), arc_cosine(0));
  EXPECT_EQ(arc_tangent(k_nan, 1), 0);
  EXPECT_EQ(arc_tangent(2, k_nan), arc_tangent(2, 0));
  EXPECT_EQ(arc_tangent(k_infinity, 1), arc_tangent(1, 0));
}

TEST(Elementary, TakesALogarithmFromTheSmallestToTheLargestNumber) {
  constexpr double largest = std::numeric_limits<double>::max();
  constexpr double smallest = std::numeric_limits<double>::denorm_min();
  for (const double too_small : {0.0, -1.0, -k_infinity, k_nan})
    EXPECT_EQ(logarithm(too_small), logarithm(smallest)) << too_small;
  EXPECT_EQ(logarithm(k_infinity), logarithm(largest));
  EXPECT_LE(units_in_last_place(logarithm(largest), std::log(largest)), 2.0);
  for (double x = smallest; x < 1e-300; x *= 3)  // subnormal numbers, below 2^-1022
    EXPECT_LE(units_in_last_place(logarithm(x), std::log(x)), 2.0) << x;
}

// Each function is the other's inverse.
TEST(Elementary, AgreesWithItsInverse) {
  for (int i = -1000; i <= 1000; ++i) {
    const double x = i * 0.003;
    EXPECT_NEAR(logarithm(exponential(x)), x, 1e-15 * (1 + std::abs(x))) << x;
    const SineCosine both = sine_cosine(x);
    EXPECT_NEAR(arc_tangent(both.sine, both.cosine), x, 1e-15) << x;
    EXPECT_NEAR(both.sine * both.sine + both.cosine * both.cosine, 1, 1e-15) << x;
    EXPECT_NEAR(std::cos(arc_cosine(i * 1e-3)), i * 1e-3, 1e-15) << x;
  }
}

// Any compiler, flag or machine that reorders or fuses a single operation changes this number.
TEST(Elementary, GivesTheSameBitsEverywhere) {
  test::Random random(6);
  test::BitHash hash;
  for (int i = 0; i < 20'000; ++i) {
    const double x = random.within(-1000, 1000);
    const SineCosine both = sine_cosine(x);
    hash.add(both.sine);
    hash.add(both.cosine);
    hash.add(logarithm(random.uniform()));
    hash.add(exponential(0.5 * x));
    hash.add(arc_tangent(both.sine, random.within(-2, 2)));
    hash.add(arc_cosine(both.cosine));
  }
  EXPECT_EQ(hash.value(), 7135819422567387964u);
}

}  // namespace
}  // namespace glint
