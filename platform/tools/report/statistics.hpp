// Descriptive statistics, histograms and Gaussian fits for reports. The core never includes it.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace glint {

// In the unit of the values. All zero without values.
struct Summary {
  std::size_t count = 0;
  double mean = 0;
  double mean_abs = 0;
  double sd = 0;   // about the mean, divided by count - 1
  double rms = 0;  // about zero
  double median = 0;
  double minimum = 0, maximum = 0;
};
[[nodiscard]] Summary summarize(std::span<const double> values);

// Nearest-rank percentile: the smallest value that at least `fraction` of the values do not exceed.
// Requires fraction in [0, 1]; returns 0 without values.
[[nodiscard]] double percentile(std::span<const double> values, double fraction);

// Upper tail probability P(X > x) of the chi-square distribution. Source: Abramowitz and Stegun
// 1964, 26.4.4 and 26.4.5.
[[nodiscard]] double chi_square_tail(double x, int degrees_of_freedom);

// Bin i covers low + i width <= value < low + (i + 1) width.
struct Histogram {
  double low = 0;
  double width = 1;
  std::vector<std::size_t> counts;
  std::size_t below = 0, above = 0;  // values outside the bins; NaN counts in `above`

  [[nodiscard]] double centre(std::size_t bin) const {
    return low + (static_cast<double>(bin) + 0.5) * width;
  }
  [[nodiscard]] double high() const { return low + static_cast<double>(counts.size()) * width; }
};

// Requires bins >= 1 and low < high; throws std::invalid_argument otherwise.
[[nodiscard]] Histogram make_histogram(std::span<const double> values, double low, double high,
                                       int bins);

// Histogram with limits symmetric about zero that contain `coverage` of the values.
[[nodiscard]] Histogram make_symmetric_histogram(std::span<const double> values, int bins,
                                                 double coverage = 0.995);

// height exp(-(x - mean)^2 / (2 sd^2)), in counts per bin.
struct GaussianFit {
  bool valid = false;
  double mean = 0;
  double sd = 0;
  double height = 0;
  [[nodiscard]] double at(double x) const;
};

// Fits a Gaussian to the histogram by weighted least squares on the logarithm, iterated with the
// squared counts of the last fit as weights. The fit follows the bulk of the values, so its sd
// beside the plain standard deviation shows heavy tails. Invalid with fewer than three non-empty
// bins or without a maximum. Source: Guo 2011, A simple algorithm for fitting a Gaussian function,
// IEEE Signal Processing Magazine 28(5), eq. (17).
[[nodiscard]] GaussianFit fit_gaussian(const Histogram& histogram);

}  // namespace glint
