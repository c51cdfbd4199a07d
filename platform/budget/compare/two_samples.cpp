#include "platform/budget/compare/two_samples.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace glint {
namespace {

double median_of(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

void resample(std::span<const double> from, std::mt19937_64& random, std::vector<double>& into) {
  const auto block = static_cast<std::size_t>(
      std::max(1.0, std::round(std::cbrt(static_cast<double>(from.size())))));
  into.clear();
  while (into.size() < from.size()) {
    const std::size_t begin = random() % (from.size() - block + 1);
    const std::size_t count = std::min(block, from.size() - into.size());
    into.insert(into.end(), from.begin() + static_cast<std::ptrdiff_t>(begin),
                from.begin() + static_cast<std::ptrdiff_t>(begin + count));
  }
}

}  // namespace

double mann_whitney(std::span<const double> a, std::span<const double> b) {
  struct Value {
    double x;
    bool of_a;
  };
  std::vector<Value> all;
  for (const double x : a) all.push_back({x, true});
  for (const double x : b) all.push_back({x, false});
  std::sort(all.begin(), all.end(), [](const Value& u, const Value& v) { return u.x < v.x; });
  double rank_sum = 0, ties = 0;
  for (std::size_t i = 0; i < all.size();) {
    std::size_t end = i, of_a = 0;
    for (; end < all.size() && all[end].x == all[i].x; ++end) of_a += all[end].of_a ? 1 : 0;
    const auto count = static_cast<double>(end - i);
    rank_sum += static_cast<double>(of_a) * (static_cast<double>(i + end + 1) / 2);
    ties += count * (count * count - 1);
    i = end;
  }
  const auto n = static_cast<double>(a.size()), m = static_cast<double>(b.size());
  const double u = rank_sum - n * (n + 1) / 2;
  const double total = n + m;
  const double variance = n * m / 12 * (total + 1 - ties / (total * (total - 1)));
  if (variance <= 0) return 1;  // all values are equal
  return std::erfc(std::abs(u - n * m / 2) / std::sqrt(2 * variance));
}

RatioInterval median_ratio(std::span<const double> a, std::span<const double> b, double confidence,
                           int resamples, std::uint64_t random_seed) {
  std::mt19937_64 random(random_seed);
  std::vector<double> of_a(a.begin(), a.end()), of_b(b.begin(), b.end()), ratios;
  RatioInterval interval;
  interval.ratio = median_of(of_b) / median_of(of_a);
  for (int r = 0; r < resamples; ++r) {
    resample(a, random, of_a);
    resample(b, random, of_b);
    ratios.push_back(median_of(of_b) / median_of(of_a));
  }
  std::sort(ratios.begin(), ratios.end());
  const auto last = static_cast<double>(ratios.size() - 1);
  interval.low = ratios[static_cast<std::size_t>((1 - confidence) / 2 * last)];
  interval.high = ratios[static_cast<std::size_t>(std::ceil((1 + confidence) / 2 * last))];
  return interval;
}

}  // namespace glint
