#include "platform/tools/report/statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace glint {
namespace {

// Quantiles of the normal distribution at equal steps of probability, by bisection of erf: a sample
// without randomness.
std::vector<double> normal_sample(double mean, double sd, int count) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) {
    const double wanted = 2 * (i + 0.5) / count - 1;
    double low = -6, high = 6;
    for (int step = 0; step < 60; ++step) {
      const double middle = 0.5 * (low + high);
      (std::erf(middle / std::sqrt(2.0)) < wanted ? low : high) = middle;
    }
    values.push_back(mean + sd * low);
  }
  return values;
}

// 95 % quantiles: Abramowitz and Stegun 1964, table 26.8.
TEST(Statistics, TailOfChiSquareIsThatOfTheTables) {
  EXPECT_NEAR(chi_square_tail(3.84146, 1), 0.05, 1e-6);
  EXPECT_NEAR(chi_square_tail(5.99146, 2), 0.05, 1e-6);
  EXPECT_NEAR(chi_square_tail(16.9190, 9), 0.05, 1e-6);
  EXPECT_NEAR(chi_square_tail(43.7729, 30), 0.05, 1e-6);
  EXPECT_EQ(chi_square_tail(0, 5), 1);
}

TEST(Statistics, SumsUpAKnownColumn) {
  const std::vector<double> values = {4, -2, 1, -3, 5};
  const Summary summary = summarize(values);
  EXPECT_EQ(summary.count, 5u);
  EXPECT_DOUBLE_EQ(summary.mean, 1);
  EXPECT_DOUBLE_EQ(summary.mean_abs, 3);
  EXPECT_DOUBLE_EQ(summary.sd, std::sqrt(50.0 / 4));
  EXPECT_DOUBLE_EQ(summary.rms, std::sqrt(11.0));
  EXPECT_DOUBLE_EQ(summary.median, 1);
  EXPECT_DOUBLE_EQ(summary.minimum, -3);
  EXPECT_DOUBLE_EQ(summary.maximum, 5);
}

TEST(Statistics, TakesTheMeanOfTheTwoMiddleValuesOfAnEvenCount) {
  EXPECT_DOUBLE_EQ(summarize(std::vector<double>{9, 1, 2, 4}).median, 3);
}

TEST(Statistics, SaysZeroOfNothing) {
  const Summary summary = summarize({});
  EXPECT_EQ(summary.count, 0u);
  EXPECT_EQ(summary.sd, 0);
  EXPECT_EQ(percentile({}, 0.5), 0);
}

TEST(Statistics, PicksPercentilesAmongTheValues) {
  std::vector<double> values;
  for (int i = 1000; i >= 1; --i) values.push_back(i);
  EXPECT_EQ(percentile(values, 0), 1);
  EXPECT_EQ(percentile(values, 0.5), 500);
  EXPECT_EQ(percentile(values, 0.99), 990);
  EXPECT_EQ(percentile(values, 0.999), 999);
  EXPECT_EQ(percentile(values, 1), 1000);
  EXPECT_EQ(percentile(std::vector<double>{3, 1, 2}, 0.5), 2);
}

TEST(Statistics, CountsEveryValueOnceAlsoAtTheEdges) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> values = {-1, -0.5, 0, 0.999, 1, 7, -7, nan};
  const Histogram histogram = make_histogram(values, -1, 1, 4);
  EXPECT_EQ(histogram.counts, (std::vector<std::size_t>{1, 1, 1, 1}));
  EXPECT_EQ(histogram.below, 1u);
  EXPECT_EQ(histogram.above, 3u);
  EXPECT_DOUBLE_EQ(histogram.centre(0), -0.75);
}

TEST(Statistics, RefusesAHistogramWithoutWidth) {
  EXPECT_THROW((void)make_histogram({}, 1, 1, 4), std::invalid_argument);
  EXPECT_THROW((void)make_histogram({}, 0, 1, 0), std::invalid_argument);
}

TEST(Statistics, FindsTheBellThatMadeTheBars) {
  const std::vector<double> values = normal_sample(0.7, 2.5, 4000);
  const GaussianFit fit = fit_gaussian(make_histogram(values, -8, 8, 40));
  ASSERT_TRUE(fit.valid);
  EXPECT_NEAR(fit.mean, 0.7, 0.02);
  EXPECT_NEAR(fit.sd, 2.5, 0.03);  // the bin width of 0.4 adds 0.005
  EXPECT_NEAR(fit.height, 4000 * 0.4 / (2.5 * std::sqrt(2 * 3.14159265)), 3);
  EXPECT_DOUBLE_EQ(fit.at(fit.mean), fit.height);
}

TEST(Statistics, FollowsTheBulkWhereTailsWidenTheDeviation) {
  std::vector<double> values = normal_sample(0, 1, 3800);
  for (const double value : normal_sample(0, 8, 200)) values.push_back(value);
  const GaussianFit fit = fit_gaussian(make_histogram(values, -10, 10, 80));
  ASSERT_TRUE(fit.valid);
  EXPECT_LT(fit.sd, 1.1);
  EXPECT_GT(summarize(values).sd, 1.9);
}

TEST(Statistics, FitsNoBellToBarsWithoutAMaximum) {
  EXPECT_FALSE(fit_gaussian(make_histogram(std::vector<double>{0.1, 0.1}, 0, 1, 10)).valid);
  Histogram valley;
  valley.counts = {50, 20, 8, 20, 50};
  EXPECT_FALSE(fit_gaussian(valley).valid);
}

TEST(Statistics, LaysASymmetricHistogramRoundZero) {
  const Histogram histogram = make_symmetric_histogram(std::vector<double>{-1, 2, 3, -4}, 8, 1.0);
  EXPECT_DOUBLE_EQ(histogram.low, -4);
  EXPECT_DOUBLE_EQ(histogram.high(), 4);
  EXPECT_EQ(make_symmetric_histogram(std::vector<double>{0, 0}, 8).counts.size(), 8u);
}

}  // namespace
}  // namespace glint
