// What a column of figures says in a few numbers. For reports only: the core never includes it.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace glint {

// In the unit of the values. All zero for no values.
struct Summary {
  std::size_t count = 0;
  double mean = 0;
  double mean_abs = 0;
  double sd = 0;   // about the mean, divided by count - 1
  double rms = 0;  // about zero
  double median = 0;
  double least = 0, greatest = 0;
};
[[nodiscard]] Summary summarize(std::span<const double> values);

// The smallest value that at least this fraction of the values does not exceed (nearest rank), so
// that it is always one of them. fraction in [0, 1]; 0 for no values.
[[nodiscard]] double percentile(std::span<const double> values, double fraction);

// P(chi-square of so many degrees of freedom > x). Source: Abramowitz and Stegun 1964, 26.4.4 and
// 26.4.5.
[[nodiscard]] double chi_square_tail(double x, int degrees_of_freedom);

// Bin i covers low + i width <= value < low + (i + 1) width.
struct Histogram {
  double low = 0;
  double width = 1;
  std::vector<std::size_t> counts;
  std::size_t below = 0, above = 0;  // values outside, NaN among the latter

  [[nodiscard]] double centre(std::size_t bin) const {
    return low + (static_cast<double>(bin) + 0.5) * width;
  }
  [[nodiscard]] double high() const { return low + static_cast<double>(counts.size()) * width; }
};

// bins >= 1 and low < high, else std::invalid_argument.
[[nodiscard]] Histogram make_histogram(std::span<const double> values, double low, double high,
                                       int bins);

// The same over limits that hold `coverage` of the values and lie alike on both sides of zero.
[[nodiscard]] Histogram make_symmetric_histogram(std::span<const double> values, int bins,
                                                 double coverage = 0.995);

// height exp(-(x - mean)^2 / (2 sd^2)), in counts a bin.
struct GaussianFit {
  bool valid = false;
  double mean = 0;
  double sd = 0;
  double height = 0;
  [[nodiscard]] double at(double x) const;
};

// A bell fitted to the histogram's bars: it follows their bulk, so that beside a plain standard
// deviation it shows how heavy the tails are. Invalid for fewer than three filled bins or bars that
// have no maximum. Source: Guo 2011, A simple algorithm for fitting a Gaussian function, IEEE
// Signal Processing Magazine 28(5), eq. (17): least squares on the logarithm, weighted by the
// squared counts of the last fit.
[[nodiscard]] GaussianFit fit_gaussian(const Histogram& histogram);

}  // namespace glint
