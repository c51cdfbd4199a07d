#include "kernels/motion/correlated_errors.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace glint {
namespace {

// Means of many samples of the autocovariance e^(-|t|/T), summed one by one.
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
    EXPECT_NEAR(of_mean(errors(1, 0), k_times, window)(2, 2), autocovariance_sum(0, 0, window, 0.5),
                2e-3)
        << window;
    EXPECT_NEAR(of_mean(errors(0, 1), k_times, window)(2, 2), autocovariance_sum(0, 0, window, 20),
                2e-3)
        << window;
    const double half = 0.5 * window;
    const double halves =
        2 * (autocovariance_sum(0, 0, half, 0.5) - autocovariance_sum(0, half, half, 0.5));
    EXPECT_NEAR(of_halves(errors(1, 0), k_times, window)(4, 4), halves, 4e-3) << window;
  }
}

TEST(CorrelatedErrors, AreWholeInNoTimeAndGoneAfterALongOne) {
  constexpr CorrelationTimes k_times{0.5, 20};
  EXPECT_DOUBLE_EQ(of_mean(errors(3, 2), k_times, 0)(0, 0), 5);
  EXPECT_DOUBLE_EQ(of_halves(errors(3, 2), k_times, 0)(0, 0), 0);
  EXPECT_LT(of_mean(errors(3, 2), k_times, 1e7)(0, 0), 0.02);
  EXPECT_TRUE(of_mean({}, k_times, 1).isZero());
}

// The closed forms and their series meet.
TEST(CorrelatedErrors, HaveNoStepBetweenShortAndLongWindows) {
  for (const double window : {0.99e-3, 1.01e-3, 2e-3}) {
    EXPECT_NEAR(of_mean(errors(1, 0), {1, 1}, window)(0, 0), 1 - window / 3, 1e-6);
    EXPECT_NEAR(of_halves(errors(1, 0), {1, 1}, 2 * window)(0, 0), 4.0 / 3 * window, 1e-5);
  }
}

}  // namespace
}  // namespace glint
