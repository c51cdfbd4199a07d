#include "kernels/motion/correlated_errors.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace glint {
namespace {

// Mean of the autocovariance e^(-|t|/T) over two windows, by a numerical double sum.
double autocovariance_sum(double from_s, double to_s, double window_s, double correlation_s) {
  constexpr int k_samples = 600;
  double sum = 0;
  for (int i = 0; i < k_samples; ++i) {
    for (int j = 0; j < k_samples; ++j) {
      const double a = from_s + window_s * (i + 0.5) / k_samples;
      const double b = to_s + window_s * (j + 0.5) / k_samples;
      sum += std::exp(-std::abs(a - b) / correlation_s);
    }
  }
  return sum / k_samples / k_samples;
}

CorrelatedErrors errors(double fast, double slow) {
  CorrelatedErrors out;
  out.fast.diagonal().setConstant(fast);
  out.slow.diagonal().setConstant(slow);
  return out;
}

TEST(CorrelatedErrors, OfAMeanAreTheIntegralOfTheirAutocovariance) {
  constexpr CorrelationTimes k_times{0.5, 20};
  for (const double window : {0.2, 1.0, 5.0, 25.0}) {
    EXPECT_NEAR(covariance_of_mean(errors(1, 0), k_times, window)(2, 2),
                autocovariance_sum(0, 0, window, 0.5), 2e-3)
        << window;
    EXPECT_NEAR(covariance_of_mean(errors(0, 1), k_times, window)(2, 2),
                autocovariance_sum(0, 0, window, 20), 2e-3)
        << window;
    const double half = 0.5 * window;
    const double halves =
        2 * (autocovariance_sum(0, 0, half, 0.5) - autocovariance_sum(0, half, half, 0.5));
    EXPECT_NEAR(halves_covariance(errors(1, 0), k_times, window)(4, 4), halves, 4e-3) << window;
  }
}

// Closed-form integrals of e^(-|t|/T), x = t/T: 2 (x - 1 + e^-x) / x^2 for one mean, ((1 - e^-x) /
// x)^2 for the product of two neighbouring means.
TEST(CorrelatedErrors, AreTheirClosedFormsEachByItsOwnTime) {
  const auto of_one = [](double x) { return 2 * (x - 1 + std::exp(-x)) / (x * x); };
  const auto of_two = [](double x) { return std::pow((1 - std::exp(-x)) / x, 2); };
  constexpr CorrelationTimes k_times{0.7, 9};
  for (const double window : {0.1, 0.5, 2.0, 30.0, 200.0}) {
    const double fast = window / 0.7, slow = window / 9;
    EXPECT_NEAR(covariance_of_mean(errors(2, 3), k_times, window)(1, 1),
                2 * of_one(fast) + 3 * of_one(slow), 2e-10)
        << window;
    const double halves = 2 * 2 * (of_one(fast / 2) - of_two(fast / 2)) +
                          3 * 2 * (of_one(slow / 2) - of_two(slow / 2));
    EXPECT_NEAR(halves_covariance(errors(2, 3), k_times, window)(5, 5), halves, 2e-10) << window;
  }
}

// Beyond 600 correlation times the result is that of 600. A correlation time or window that is not
// positive averages nothing.
TEST(CorrelatedErrors, EndAtALongWindowAndBeginAtNone) {
  const double last = covariance_of_mean(errors(1, 0), {1, 1}, 600)(0, 0);
  EXPECT_NEAR(last, 2.0 / 600 * (1 - 1.0 / 600), 1e-12);
  EXPECT_EQ(covariance_of_mean(errors(1, 0), {1, 1}, 601)(0, 0), last);
  EXPECT_EQ(covariance_of_mean(errors(1, 0), {1, 1}, std::numeric_limits<double>::infinity())(0, 0),
            last);
  EXPECT_GT(covariance_of_mean(errors(1, 0), {1, 1}, 599)(0, 0), last);
  for (const double none : {0.0, -1.0}) {
    EXPECT_EQ(covariance_of_mean(errors(1, 0), {1, 1}, none)(0, 0), 1);
    EXPECT_EQ(covariance_of_mean(errors(1, 0), {none, 1}, 1)(0, 0), 1);
    EXPECT_EQ(halves_covariance(errors(1, 0), {1, 1}, none)(0, 0), 0);
    EXPECT_EQ(halves_covariance(errors(0, 1), {1, none}, 1)(0, 0), 0);
  }
  EXPECT_EQ(CorrelatedErrors(errors(2, 3)).sum()(0, 0), 5);
}

TEST(CorrelatedErrors, AreWholeInNoTimeAndGoneAfterALongOne) {
  constexpr CorrelationTimes k_times{0.5, 20};
  EXPECT_DOUBLE_EQ(covariance_of_mean(errors(3, 2), k_times, 0)(0, 0), 5);
  EXPECT_DOUBLE_EQ(halves_covariance(errors(3, 2), k_times, 0)(0, 0), 0);
  EXPECT_LT(covariance_of_mean(errors(3, 2), k_times, 1e7)(0, 0), 0.02);
  EXPECT_TRUE(covariance_of_mean({}, k_times, 1).isZero());
}

// The closed forms and their series are continuous where they meet.
TEST(CorrelatedErrors, HaveNoStepBetweenShortAndLongWindows) {
  for (const double window : {0.99e-3, 1.01e-3, 2e-3}) {
    EXPECT_NEAR(covariance_of_mean(errors(1, 0), {1, 1}, window)(0, 0), 1 - window / 3, 1e-6);
    EXPECT_NEAR(halves_covariance(errors(1, 0), {1, 1}, 2 * window)(0, 0), 4.0 / 3 * window, 1e-5);
  }
}

}  // namespace
}  // namespace glint
