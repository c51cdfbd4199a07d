// What stays right where some of the values are wrong: medians and the sigma that they tell, limits
// of what is kept, the loss of what is not.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <ranges>
#include <utility>
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

// Beyond it lies one good sample in 1000, of so many components.
inline constexpr double k_chi_square_of_three = 16.3, k_chi_square_of_six = 22.5;

// Where Cauchy's loss bends: what misses by more counts ever less.
inline constexpr double k_cauchy_sigmas = 3;

// Of as many items as `kept` has, those that it keeps.
template <std::ranges::random_access_range Items>
[[nodiscard]] std::vector<std::ranges::range_value_t<Items>> kept_of(
    const Items& items, const std::vector<bool>& kept) {
  std::vector<std::ranges::range_value_t<Items>> result;
  for (std::size_t i = 0; i < kept.size(); ++i)
    if (kept[i]) result.push_back(items[i]);
  return result;
}

}  // namespace glint
