#include "kernels/motion/correlated_errors.hpp"

#include "kernels/elementary.hpp"

namespace glint {
namespace {

// In correlation times. Below k_short a series replaces the closed forms, which lose digits there.
// k_long limits the argument: little variance is left.
constexpr double k_short = 1e-3, k_long = 600;

double correlations(double window_s, double correlation_s) {
  const double x = window_s > 0 && correlation_s > 0 ? window_s / correlation_s : 0;
  return x < k_long ? x : k_long;
}

// (1 - e^-x) / x
double kept(double x) { return x < k_short ? 1 - 0.5 * x : (1 - exponential(-x)) / x; }

// Variance of a mean over x correlation times: 2 / x (1 - kept(x)).
double mean_variance(double x) { return x < k_short ? 1 - x / 3 : 2 / x * (1 - kept(x)); }

// Variance of the difference between two adjacent means over x correlation times each.
double halves_variance(double x) {
  const double both = kept(x);
  return x < k_short ? 4.0 / 3 * x : 2 * (mean_variance(x) - both * both);
}

}  // namespace

Matrix6 covariance_of_mean(const CorrelatedErrors& errors, const CorrelationTimes& times,
                           double window_s) noexcept {
  return mean_variance(correlations(window_s, times.fast_s)) * errors.fast +
         mean_variance(correlations(window_s, times.slow_s)) * errors.slow;
}

Matrix6 halves_covariance(const CorrelatedErrors& errors, const CorrelationTimes& times,
                          double window_s) noexcept {
  return halves_variance(correlations(0.5 * window_s, times.fast_s)) * errors.fast +
         halves_variance(correlations(0.5 * window_s, times.slow_s)) * errors.slow;
}

}  // namespace glint
