#include "platform/tools/report/statistics.hpp"

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace glint {
namespace {

constexpr int k_gaussian_iterations = 30;  // Guo 2011 needs 10 if half of the bars are noise

}  // namespace

Summary summarize(std::span<const double> values) {
  Summary summary;
  summary.count = values.size();
  if (values.empty()) return summary;
  const double n = static_cast<double>(values.size());
  double sum = 0, sum_abs = 0, sum_square = 0;
  for (const double value : values) {
    sum += value;
    sum_abs += std::abs(value);
    sum_square += value * value;
  }
  summary.mean = sum / n;
  summary.mean_abs = sum_abs / n;
  summary.rms = std::sqrt(sum_square / n);
  double about_mean = 0;
  for (const double value : values) about_mean += (value - summary.mean) * (value - summary.mean);
  summary.sd = values.size() > 1 ? std::sqrt(about_mean / (n - 1)) : 0;
  std::vector<double> sorted(values.begin(), values.end());
  std::sort(sorted.begin(), sorted.end());
  const std::size_t middle = sorted.size() / 2;
  summary.median =
      sorted.size() % 2 == 1 ? sorted[middle] : 0.5 * (sorted[middle - 1] + sorted[middle]);
  summary.minimum = sorted.front();
  summary.maximum = sorted.back();
  return summary;
}

double percentile(std::span<const double> values, double fraction) {
  if (values.empty()) return 0;
  const double rank = std::ceil(fraction * static_cast<double>(values.size()));
  const auto index = static_cast<std::size_t>(std::max(rank, 1.0)) - 1;
  std::vector<double> copy(values.begin(), values.end());
  const auto position =
      copy.begin() + static_cast<std::ptrdiff_t>(std::min(index, copy.size() - 1));
  std::nth_element(copy.begin(), position, copy.end());
  return *position;
}

double chi_square_tail(double x, int degrees_of_freedom) {
  if (!(x > 0)) return 1;
  const bool odd = degrees_of_freedom % 2 == 1;
  double tail = odd ? std::erfc(std::sqrt(0.5 * x)) : 0;
  double term = odd ? std::sqrt(2 * x / std::numbers::pi) : 1;
  term *= std::exp(-0.5 * x);
  for (int k = odd ? 3 : 2; k <= degrees_of_freedom; k += 2) {
    tail += term;
    term *= x / k;
  }
  return tail;
}

Histogram make_histogram(std::span<const double> values, double low, double high, int bins) {
  if (bins < 1 || !(low < high)) throw std::invalid_argument("a histogram needs low < high");
  Histogram histogram;
  histogram.low = low;
  histogram.width = (high - low) / bins;
  histogram.counts.assign(static_cast<std::size_t>(bins), 0);
  for (const double value : values) {
    const double bin = std::floor((value - low) / histogram.width);
    if (bin < 0) {
      ++histogram.below;
    } else if (bin < bins) {
      ++histogram.counts[static_cast<std::size_t>(bin)];
    } else {
      ++histogram.above;
    }
  }
  return histogram;
}

Histogram make_symmetric_histogram(std::span<const double> values, int bins, double coverage) {
  std::vector<double> sizes;
  sizes.reserve(values.size());
  for (const double value : values) sizes.push_back(std::abs(value));
  const double limit = percentile(sizes, coverage);
  return limit > 0 ? make_histogram(values, -limit, limit, bins)
                   : make_histogram(values, -1, 1, bins);
}

double GaussianFit::at(double x) const {
  if (!valid) return 0;
  const double z = (x - mean) / sd;
  return height * std::exp(-0.5 * z * z);
}

GaussianFit fit_gaussian(const Histogram& histogram) {
  // x in bins about the middle, scaled: the powers stay near 1.
  const std::size_t bins = histogram.counts.size();
  const double middle = 0.5 * static_cast<double>(bins);
  const double scale = std::max(middle, 1.0);
  const auto filled = std::count_if(histogram.counts.begin(), histogram.counts.end(),
                                    [](std::size_t count) { return count > 0; });
  if (filled < 3) return {};
  Eigen::Vector3d parabola = Eigen::Vector3d::Zero();
  for (int iteration = 0; iteration < k_gaussian_iterations; ++iteration) {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < bins; ++i) {
      if (histogram.counts[i] == 0) continue;
      const double x = (static_cast<double>(i) + 0.5 - middle) / scale;
      const double count = static_cast<double>(histogram.counts[i]);
      const Eigen::Vector3d powers(1, x, x * x);
      const double weight =
          iteration == 0 ? count : std::exp(std::min(parabola.dot(powers), 300.0));
      normal += weight * weight * powers * powers.transpose();
      right += weight * weight * std::log(count) * powers;
    }
    parabola = normal.inverse() * right;
    if (!parabola.allFinite() || !(parabola[2] < 0)) return {};
  }
  const double mean = -parabola[1] / (2 * parabola[2]);
  const double sd = std::sqrt(-1 / (2 * parabola[2]));
  GaussianFit fit;
  fit.valid = true;
  fit.mean = histogram.low + (mean * scale + middle) * histogram.width;
  fit.sd = sd * scale * histogram.width;
  fit.height = std::exp(parabola[0] - parabola[1] * parabola[1] / (4 * parabola[2]));
  return fit;
}

}  // namespace glint
