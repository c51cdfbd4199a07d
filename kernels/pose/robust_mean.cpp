#include "kernels/pose/robust_mean.hpp"

#include <algorithm>

#include "kernels/merge_sort.hpp"

namespace glint {
namespace {

constexpr double k_inlier_deviations = 3 * 1.4826;

double middle_of(const RangeValues& sorted, int count) {
  const auto middle = static_cast<std::size_t>(count / 2);
  return count % 2 == 1 ? sorted[middle] : 0.5 * (sorted[middle - 1] + sorted[middle]);
}

// Both sides of the median are in order already: their deviations only have to be merged.
double median_deviation(const RangeValues& sorted, int count, double median) {
  const auto value = [&](int i) { return sorted[static_cast<std::size_t>(i)]; };
  int left = count / 2 - 1, right = count / 2;
  double before = 0, here = 0;  // the two newest of the merged deviations
  for (int i = 0; i <= count / 2; ++i) {
    const bool from_left =
        right >= count || (left >= 0 && median - value(left) < value(right) - median);
    before = here;
    here = from_left ? median - value(left) : value(right) - median;
    left -= from_left ? 1 : 0;
    right += from_left ? 0 : 1;
  }
  return count % 2 == 1 ? here : 0.5 * (before + here);
}

}  // namespace

RobustMean robust_mean(const RangeValues& values, int count, double gate_least) noexcept {
  RangeValues sorted, spare;
  std::copy_n(values.begin(), count, sorted.begin());
  merge_sort(sorted, spare, count);
  RobustMean out;
  out.median = middle_of(sorted, count);
  out.gate =
      std::max(k_inlier_deviations * median_deviation(sorted, count, out.median), gate_least);
  double sum = 0;
  int inliers = 0;
  for (int i = 0; i < count; ++i) {
    const double value = sorted[static_cast<std::size_t>(i)];
    const bool near = out.counts(value);
    sum += near ? value : 0.0;
    inliers += near ? 1 : 0;
  }
  out.mean = inliers > 0 ? sum / inliers : out.median;
  return out;
}

}  // namespace glint
