#include "platform/budget/estimate/extreme_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "platform/budget/estimate/series_tests.hpp"

namespace glint {
namespace {

constexpr double k_euler = 0.57721566490153286;
constexpr double k_shape_epsilon = 1e-6;  // closer to zero the limit forms are more accurate

// b_0, b_1, b_2: unbiased estimates of E[x F(x)^r].
std::array<double, 3> weighted_moments(std::span<const double> values) {
  std::vector<double> sorted(values.begin(), values.end());
  std::sort(sorted.begin(), sorted.end());
  const auto n = static_cast<double>(sorted.size());
  std::array<double, 3> b{};
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    const auto j = static_cast<double>(i);  // values below this one
    b[0] += sorted[i] / n;
    b[1] += sorted[i] / n * j / (n - 1);
    b[2] += sorted[i] / n * j * (j - 1) / ((n - 1) * (n - 2));
  }
  return b;
}

}  // namespace

double ExtremeDistribution::cumulative(double x) const {
  const double z = (x - location) / scale;
  const bool straight = std::abs(shape) < k_shape_epsilon;
  const double inside = 1 + shape * z;
  if (family == Family::exceedances && z <= 0) return 0;
  if (!straight && inside <= 0) return shape > 0 ? 0 : 1;
  const double tail = straight ? std::exp(-z) : std::pow(inside, -1 / shape);
  return family == Family::maxima ? std::exp(-tail) : 1 - tail;
}

double ExtremeDistribution::quantile(double p) const {
  const double y = family == Family::maxima ? -std::log(p) : 1 - p;
  if (std::abs(shape) < k_shape_epsilon) return location - scale * std::log(y);
  return location + scale / shape * (std::pow(y, -shape) - 1);
}

ExtremeDistribution fit_maxima(std::span<const double> maxima) {
  const auto [b0, b1, b2] = weighted_moments(maxima);
  const double c = (2 * b1 - b0) / (3 * b2 - b0) - std::log(2.0) / std::log(3.0);
  const double k = 7.8590 * c + 2.9554 * c * c;
  if (std::abs(k) < k_shape_epsilon) return fit_gumbel(maxima);
  const double gamma = std::tgamma(1 + k);
  const double scale = (2 * b1 - b0) * k / (gamma * (1 - std::pow(2.0, -k)));
  return {ExtremeDistribution::Family::maxima, b0 + scale * (gamma - 1) / k, scale, -k};
}

ExtremeDistribution fit_gumbel(std::span<const double> maxima) {
  const auto [b0, b1, b2] = weighted_moments(maxima);
  const double scale = (2 * b1 - b0) / std::log(2.0);
  return {ExtremeDistribution::Family::maxima, b0 - k_euler * scale, scale, 0};
}

ExtremeDistribution fit_exceedances(std::span<const double> values, double threshold) {
  std::vector<double> above;
  for (const double x : values) {
    if (x > threshold) above.push_back(x - threshold);
  }
  // The paper's a_r weighs by (1 - F)^r: a_0 = b_0, a_1 = b_0 - b_1.
  const auto [b0, b1, b2] = weighted_moments(above);
  const double a1 = b0 - b1;
  const double k = b0 / (b0 - 2 * a1) - 2;
  const double scale = 2 * b0 * a1 / (b0 - 2 * a1);
  return {ExtremeDistribution::Family::exceedances, threshold, scale, -k};
}

double kolmogorov_smirnov_p(std::span<const double> values,
                            const ExtremeDistribution& distribution) {
  std::vector<double> sorted(values.begin(), values.end());
  std::sort(sorted.begin(), sorted.end());
  const auto n = static_cast<double>(sorted.size());
  double distance = 0;
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    const double f = distribution.cumulative(sorted[i]);
    const auto j = static_cast<double>(i);
    distance = std::max({distance, std::abs(f - j / n), std::abs((j + 1) / n - f)});
  }
  return kolmogorov_p(distance, n);
}

}  // namespace glint
