#include "kernels/pose/robust_mean.hpp"

#include <algorithm>
#include <limits>

#include "kernels/sort_pairs.hpp"

namespace glint {
namespace {

constexpr double k_inlier_deviations = 3 * 1.4826;
constexpr double k_infinite = std::numeric_limits<double>::infinity();

// Ascending, with infinity after the last value; two more than the capacity, since pairs are read.
using Sorted = std::array<double, k_range_values_max + 2>;
static_assert(k_range_values_max == k_sort_pairs_max);

double middle_of(const Sorted& sorted, int count) {
  const auto middle = static_cast<std::size_t>(count / 2);
  return count % 2 == 1 ? sorted[middle] : 0.5 * (sorted[middle - 1] + sorted[middle]);
}

// The deviation from the median that `others` other values do not exceed. The nearest values to the
// median are contiguous: of all windows of that length, the one whose farther end is nearest.
double deviation_order_statistic(const Sorted& sorted, int count, double median, int others) {
  const double* const from = sorted.data();
  TwoDoubles least = broadcast_two(k_infinite);
  for (int i = 0; i < count - others; i += 2) {
    const TwoDoubles below = broadcast_two(median) - load_two(from + i);
    const TwoDoubles above = load_two(from + i + others) - broadcast_two(median);
    least = minimum(least, maximum(below, above));
  }
  return std::min(least[0], least[1]);
}

double median_deviation(const Sorted& sorted, int count, double median) {
  const double here = deviation_order_statistic(sorted, count, median, count / 2);
  if (count % 2 == 1) return here;
  return 0.5 * (deviation_order_statistic(sorted, count, median, count / 2 - 1) + here);
}

}  // namespace

RobustMean robust_mean(const RangeValues& values, int count, double gate_min) noexcept {
  Sorted sorted;
  sorted.fill(k_infinite);
  std::copy_n(values.begin(), count, sorted.begin());
  sort_pairs(sorted.data(), count);
  RobustMean out;
  out.median = middle_of(sorted, count);
  out.gate = std::max(k_inlier_deviations * median_deviation(sorted, count, out.median), gate_min);
  NearSum near, near_too;  // two independent sums run in parallel
  for (int i = 0; i < count; i += 4) {
    const TwoDoubles two = load_two(sorted.data() + i), next = load_two(sorted.data() + i + 2);
    near.add(out, two, two);
    near_too.add(out, next, next);
  }
  near.add(near_too);
  out.mean = near.mean_or(out.median);
  out.near = near.count();
  return out;
}

}  // namespace glint
