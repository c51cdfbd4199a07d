// Two-sample comparison of dependent times: Mann-Whitney test and block bootstrap interval.
#pragma once

#include <cstdint>
#include <span>

namespace glint {

// Two-sided p-value of the Mann-Whitney U test, with the correction for ties. Source: Mann and
// Whitney 1947, On a test of whether one of two random variables is stochastically larger than the
// other; the normal limit.
[[nodiscard]] double mann_whitney(std::span<const double> a, std::span<const double> b);

struct RatioInterval {
  double ratio = 1;  // median of b over median of a
  double low = 1, high = 1;
};

// Percentile interval of the ratio of medians by moving-block bootstrap. Times of one run are
// autocorrelated; resampling of single values would make the interval too narrow. Blocks of n^(1/3)
// values. Source: Kuensch 1989, The jackknife and the bootstrap for general stationary
// observations, section 2.3 (moving blocks).
[[nodiscard]] RatioInterval median_ratio(std::span<const double> a, std::span<const double> b,
                                         double confidence, int resamples,
                                         std::uint64_t random_seed);

}  // namespace glint
