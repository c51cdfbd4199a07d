#include "kernels/pose/robust_mean.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "kernels/sort_pairs.hpp"

namespace glint {
namespace {

double middle_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return n % 2 == 1 ? values[n / 2] : 0.5 * (values[n / 2 - 1] + values[n / 2]);
}

// Reference version.
RobustMean reference_mean(const std::vector<double>& values, double gate_least) {
  RobustMean out;
  out.median = middle_of(values);
  std::vector<double> deviations;
  for (const double value : values) deviations.push_back(std::abs(value - out.median));
  out.gate = std::max(3 * 1.4826 * middle_of(deviations), gate_least);
  double sum = 0;
  int inliers = 0;
  for (const double value : values) {
    if (std::abs(value - out.median) > out.gate) continue;
    sum += value;
    ++inliers;
  }
  out.mean = inliers > 0 ? sum / inliers : out.median;
  out.near = inliers;
  return out;
}

RobustMean fast(const std::vector<double>& values, double gate_least) {
  RangeValues array{};
  std::copy(values.begin(), values.end(), array.begin());
  return robust_mean(array, static_cast<int>(values.size()), gate_least);
}

void expect_same(const std::vector<double>& values, double gate_least) {
  const RobustMean expected = reference_mean(values, gate_least), found = fast(values, gate_least);
  EXPECT_EQ(found.median, expected.median) << values.size();
  EXPECT_EQ(found.gate, expected.gate) << values.size();
  EXPECT_NEAR(found.mean, expected.mean, 1e-14) << values.size();
  EXPECT_EQ(found.near, expected.near) << values.size();
}

TEST(RobustMean, IsWhatThePlainVersionFinds) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.5, 0.004);
  std::uniform_real_distribution<double> anywhere(-1, 5);
  for (int n = 1; n <= k_range_values_max; ++n) {
    for (int wrong = 0; wrong <= n; wrong += 1 + n / 4) {
      std::vector<double> values;
      for (int i = 0; i < n; ++i) values.push_back(i < wrong ? anywhere(random) : noise(random));
      std::shuffle(values.begin(), values.end(), random);
      expect_same(values, 0.001);
      expect_same(values, 0);
    }
  }
}

TEST(RobustMean, TakesValuesThatAreEqual) {
  std::mt19937 random(4);
  for (int n = 1; n <= k_range_values_max; ++n) {
    std::vector<double> values;
    for (int i = 0; i < n; ++i) values.push_back(0.001 * static_cast<double>(300 + random() % 3));
    expect_same(values, 0.001);
    expect_same(values, 0);
    EXPECT_EQ(fast(std::vector<double>(static_cast<std::size_t>(n), 0.25), 0).mean, 0.25);
  }
}

TEST(RobustMean, BearsThatHalfOfTheValuesAreWrong) {
  for (int n = 3; n <= k_range_values_max; ++n) {
    std::vector<double> values;
    for (int i = 0; i < n; ++i) {
      const bool is_wrong = i < (n - 1) / 2;
      values.push_back(is_wrong ? 1 + 0.04 * i : 0.5 + 0.0001 * (i % 7));
    }
    EXPECT_NEAR(fast(values, 0.001).mean, 0.5003, 0.0003) << n;
  }
}

TEST(RobustMean, OfOneValueIsThatValue) {
  const RobustMean found = fast({0.37}, 0.001);
  EXPECT_EQ(found.mean, 0.37);
  EXPECT_EQ(found.median, 0.37);
  EXPECT_EQ(found.gate, 0.001);
}

TEST(SortPairs, SortsAnyNumberOfValuesThatItHasRoomFor) {
  std::mt19937 random(5);
  for (int n = 0; n <= k_sort_pairs_max; ++n) {
    for (int kinds : {2, 5, 1'000'000}) {
      std::array<double, k_sort_pairs_max> values, expected;
      for (double& value : values) value = static_cast<double>(random()) / kinds;
      for (double& value : values) value = std::floor(value) - 1000;
      expected = values;
      sort_pairs(values.data(), n);
      std::sort(expected.begin(), expected.begin() + n);
      EXPECT_TRUE(std::equal(expected.begin(), expected.begin() + n, values.begin())) << n;
    }
  }
}

}  // namespace
}  // namespace glint
