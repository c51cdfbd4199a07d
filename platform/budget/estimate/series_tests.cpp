#include "platform/budget/estimate/series_tests.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <vector>

namespace glint {
namespace {

// For an even number of degrees of freedom the chi-squared tail is a finite sum of Poisson terms.
double chi_squared_p(double value, int degrees) {
  double term = std::exp(-value / 2), sum = term;
  for (int i = 1; i < degrees / 2; ++i) {
    term *= value / 2 / i;
    sum += term;
  }
  return std::min(1.0, sum);
}

// Number of inversions (strictly decreasing pairs), by merge sort; sorts the range.
std::int64_t inversions(std::span<double> values, std::span<double> scratch) {
  if (values.size() < 2) return 0;
  const std::size_t middle = values.size() / 2;
  std::int64_t count = inversions(values.first(middle), scratch.first(middle)) +
                       inversions(values.subspan(middle), scratch.subspan(middle));
  std::size_t left = 0, right = middle, out = 0;
  while (left < middle || right < values.size()) {
    if (right == values.size() || (left < middle && values[left] <= values[right])) {
      scratch[out++] = values[left++];
    } else {
      count += static_cast<std::int64_t>(middle - left);
      scratch[out++] = values[right++];
    }
  }
  std::copy(scratch.begin(), scratch.begin() + static_cast<std::ptrdiff_t>(out), values.begin());
  return count;
}

double median_of(std::span<const double> series) {
  std::vector<double> sorted(series.begin(), series.end());
  std::sort(sorted.begin(), sorted.end());
  return sorted[sorted.size() / 2];
}

}  // namespace

double two_sided_normal_p(double z) { return std::erfc(std::abs(z) / std::sqrt(2.0)); }

double kolmogorov_p(double d, double n) {
  const double root = std::sqrt(n);
  const double lambda = (root + 0.12 + 0.11 / root) * d;
  if (lambda < 0.2) return 1;  // the sum below equals 1 in double precision
  double sum = 0;
  for (int k = 1; k <= 100; ++k) {
    sum += (k % 2 == 1 ? 2 : -2) * std::exp(-2.0 * k * k * lambda * lambda);
  }
  return std::clamp(sum, 0.0, 1.0);
}

double ljung_box(std::span<const double> series, int lags) {
  const auto n = static_cast<double>(series.size());
  double mean = 0, energy = 0;
  for (const double x : series) mean += x / n;
  for (const double x : series) energy += (x - mean) * (x - mean);
  if (energy <= 0) return 0;  // a constant series fails
  double q = 0;
  for (int lag = 1; lag <= lags; ++lag) {
    double product = 0;
    for (std::size_t i = static_cast<std::size_t>(lag); i < series.size(); ++i) {
      product += (series[i] - mean) * (series[i - static_cast<std::size_t>(lag)] - mean);
    }
    const double r = product / energy;
    q += n * (n + 2) * r * r / (n - lag);
  }
  return chi_squared_p(q, lags);
}

double runs_test(std::span<const double> series) {
  const double median = median_of(series);
  double above = 0, below = 0, runs = 0;
  int last = 0;
  for (const double x : series) {
    if (x == median) continue;
    const int side = x > median ? 1 : -1;
    (side > 0 ? above : below) += 1;
    if (side != last) runs += 1;
    last = side;
  }
  const double n = above + below;
  if (above < 1 || below < 1) return 0;
  const double expected = 2 * above * below / n + 1;
  const double variance = (expected - 1) * (expected - 2) / (n - 1);
  return two_sided_normal_p((runs - expected) / std::sqrt(variance));
}

double mann_kendall(std::span<const double> series) {
  const auto n = static_cast<double>(series.size());
  std::map<double, double> ties;
  for (const double x : series) ties[x] += 1;
  double tied_pairs = 0, tied_variance = 0;
  for (const auto& [value, t] : ties) {
    tied_pairs += t * (t - 1) / 2;
    tied_variance += t * (t - 1) * (2 * t + 5);
  }
  std::vector<double> values(series.begin(), series.end()), scratch(series.size());
  const auto falling = static_cast<double>(inversions(values, scratch));
  const double s = n * (n - 1) / 2 - tied_pairs - 2 * falling;
  const double variance = (n * (n - 1) * (2 * n + 5) - tied_variance) / 18;
  if (variance <= 0) return 0;
  const double corrected = s > 0 ? s - 1 : s < 0 ? s + 1 : 0;  // continuity correction
  return two_sided_normal_p(corrected / std::sqrt(variance));
}

double two_halves_p(std::span<const double> series) {
  const std::size_t half = series.size() / 2;
  std::vector<double> a(series.begin(), series.begin() + static_cast<std::ptrdiff_t>(half));
  std::vector<double> b(series.begin() + static_cast<std::ptrdiff_t>(half), series.end());
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  const auto n = static_cast<double>(a.size()), m = static_cast<double>(b.size());
  double distance = 0;
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    const double x = std::min(a[i], b[j]);
    while (i < a.size() && a[i] <= x) ++i;
    while (j < b.size() && b[j] <= x) ++j;
    distance =
        std::max(distance, std::abs(static_cast<double>(i) / n - static_cast<double>(j) / m));
  }
  return kolmogorov_p(distance, n * m / (n + m));
}

}  // namespace glint
