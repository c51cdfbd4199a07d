// Medians, and the sigma that they tell: half of the values may be wrong by anything.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace glint {

// 1.4826 times the median absolute deviation of a normal distribution is its sigma.
// Source: Huber 1981, Robust Statistics, section 5.1.
inline constexpr double k_sigma_of_median_deviation = 1.4826;

// Of at least one value; the upper of two middle ones.
[[nodiscard]] inline double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Sigma of values with mean zero.
[[nodiscard]] inline double sigma_of(std::vector<double> values) {
  for (double& value : values) value = std::abs(value);
  return k_sigma_of_median_deviation * median_of(std::move(values));
}

}  // namespace glint
