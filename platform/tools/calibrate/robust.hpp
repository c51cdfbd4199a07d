// Robust statistics: median, standard deviation from the median absolute deviation, outlier limits,
// Cauchy loss scale.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <ranges>
#include <utility>
#include <vector>

namespace glint {

// Ratio of a normal distribution's standard deviation to its median absolute deviation.
// Source: Huber 1981, Robust Statistics, section 5.1.
inline constexpr double k_sigma_of_median_deviation = 1.4826;

// Requires at least one value. Of an even count, returns the upper of the two middle values.
[[nodiscard]] inline double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Standard deviation of values with mean zero, from their median magnitude.
[[nodiscard]] inline double sigma_of(std::vector<double> values) {
  for (double& value : values) value = std::abs(value);
  return k_sigma_of_median_deviation * median_of(std::move(values));
}

// Chi-square limits that one valid sample in 1000 exceeds, for 3 and 6 components.
inline constexpr double k_chi_square_of_three = 16.3, k_chi_square_of_six = 22.5;

// Scale of the Cauchy loss in standard deviations: the influence of larger residuals decreases.
inline constexpr double k_cauchy_sigmas = 3;

// Returns the items whose `kept` is true; reads kept.size() items.
template <std::ranges::random_access_range Items>
[[nodiscard]] std::vector<std::ranges::range_value_t<Items>> kept_of(
    const Items& items, const std::vector<bool>& kept) {
  std::vector<std::ranges::range_value_t<Items>> result;
  for (std::size_t i = 0; i < kept.size(); ++i)
    if (kept[i]) result.push_back(items[i]);
  return result;
}

}  // namespace glint
