#include "platform/budget/estimate/extreme_estimate.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <set>

#include "platform/budget/estimate/series_tests.hpp"

namespace glint {
namespace {

using Values = std::vector<double>;

std::string p_text(double p) {
  char text[32];
  std::snprintf(text, sizeof text, p == 0 ? "0" : p < 1e-4 ? "%.1e" : "%.4f", p);
  return text;
}

// Two tests per assumption, since each test is blind to some violations.
bool passes_series_tests(std::span<const double> series, const ExtremeSettings& settings,
                         ExtremeEstimate& estimate) {
  estimate.values = series.size();
  const auto least = static_cast<std::size_t>(2 * settings.block * settings.blocks_min);
  if (series.size() < least) {
    estimate.reason = std::to_string(series.size()) + " values; at least " + std::to_string(least) +
                      " are needed (two halves of " + std::to_string(settings.blocks_min) +
                      " blocks of " + std::to_string(settings.block) + ")";
    return false;
  }
  const auto add = [&](const char* name, const char* assumption, double p) {
    estimate.tests.push_back({name, assumption, p, p >= settings.significance});
  };
  add("Ljung-Box", "independent", ljung_box(series, settings.lags));
  add("runs about the median", "independent", runs_test(series));
  add("Mann-Kendall", "stationary", mann_kendall(series));
  add("Kolmogorov-Smirnov of the halves", "stationary", two_halves_p(series));
  for (const TestResult& test : estimate.tests) {
    if (test.passed) continue;
    estimate.reason = "not " + test.assumption + " (" + test.name + ", p = " + p_text(test.p) +
                      ", refused below " + p_text(settings.significance) + ")";
    return false;
  }
  return true;
}

// Verifies the fit on the other half: its distribution, and the count above the fitted 90 %
// quantile.
bool verifies_on_other_half(const Values& verification, const ExtremeSettings& settings,
                            ExtremeEstimate& estimate) {
  const double shape_p = kolmogorov_smirnov_p(verification, estimate.distribution);
  const double beyond = estimate.distribution.quantile(0.9);
  const auto n = static_cast<double>(verification.size());
  const auto above = static_cast<double>(std::count_if(verification.begin(), verification.end(),
                                                       [&](double x) { return x > beyond; }));
  const double tail_p = two_sided_normal_p((above - 0.1 * n) / std::sqrt(0.09 * n));
  estimate.tests.push_back(
      {"the other half's distribution", "verified", shape_p, shape_p >= settings.significance});
  estimate.tests.push_back({"the other half beyond the 90 % quantile (" +
                                std::to_string(static_cast<int>(above)) + " of " +
                                std::to_string(verification.size()) + ")",
                            "verified", tail_p, tail_p >= settings.significance});
  estimate.verification_values = verification;
  std::sort(estimate.verification_values.begin(), estimate.verification_values.end());
  for (std::size_t i = estimate.tests.size() - 2; i < estimate.tests.size(); ++i) {
    const TestResult& test = estimate.tests[i];
    if (test.passed) continue;
    estimate.reason =
        "the fit to one half fails on the other (" + test.name + ", p = " + p_text(test.p) + ")";
    return false;
  }
  return true;
}

bool too_few_distinct(const Values& values, ExtremeEstimate& estimate) {
  const std::set<double> distinct(values.begin(), values.end());
  if (2 * distinct.size() >= values.size()) return false;
  estimate.reason = "only " + std::to_string(distinct.size()) + " different values among " +
                    std::to_string(values.size()) + " extremes: the distribution is not continuous";
  return true;
}

// Parametric bootstrap interval of the level. Source: Efron and Tibshirani 1993, An introduction to
// the bootstrap, section 13.3 (percentiles).
template <class Fit, class Level>
void add_interval(const ExtremeSettings& settings, ExtremeEstimate& estimate, Fit&& fit,
                  Level&& level) {
  std::mt19937_64 random(20240229);  // fixed, so that a report is reproducible
  Values levels, sample(estimate.fitted);
  for (int r = 0; r < settings.resamples; ++r) {
    for (double& x : sample) {
      const double u = (static_cast<double>(random() >> 11) + 0.5) * 0x1p-53;
      x = estimate.distribution.quantile(u);
    }
    levels.push_back(level(fit(sample)));
  }
  std::sort(levels.begin(), levels.end());
  const auto at = [&](double part) {
    return levels[static_cast<std::size_t>(part * static_cast<double>(levels.size() - 1) + 0.5)];
  };
  estimate.low = std::min(at((1 - settings.interval) / 2), estimate.level);
  estimate.high = std::max(at((1 + settings.interval) / 2), estimate.level);
  char text[120];
  if (estimate.distribution.shape >= settings.shape_max) {
    std::snprintf(text, sizeof text, "the tail is too heavy for the fit (shape %.2f, at most %.2f)",
                  estimate.distribution.shape, settings.shape_max);
    estimate.reason = text;
  } else if (!(estimate.high <= settings.interval_ratio_max * estimate.low)) {
    std::snprintf(text, sizeof text,
                  "the observed values do not determine the level: its interval is %.4g to %.4g",
                  estimate.low, estimate.high);
    estimate.reason = text;
  }
  estimate.applicable = estimate.reason.empty();
}

Values block_maxima(std::span<const double> series, int block) {
  Values maxima;
  const auto size = static_cast<std::size_t>(block);
  for (std::size_t at = 0; at + size <= series.size(); at += size) {
    const auto part = series.subspan(at, size);
    maxima.push_back(*std::max_element(part.begin(), part.end()));
  }
  return maxima;
}

}  // namespace

ExtremeEstimate estimate_by_maxima(std::span<const double> series,
                                   const ExtremeSettings& settings) {
  ExtremeEstimate estimate;
  estimate.method = "maxima of blocks of " + std::to_string(settings.block) +
                    ", generalized extreme values by probability-weighted moments";
  if (!passes_series_tests(series, settings, estimate)) return estimate;
  const std::size_t half = series.size() / 2;
  const Values fitted = block_maxima(series.first(half), settings.block);
  const Values verification = block_maxima(series.subspan(half), settings.block);
  estimate.fitted = fitted.size();
  estimate.verified = verification.size();
  if (too_few_distinct(fitted, estimate)) return estimate;
  estimate.distribution = fit_maxima(fitted);
  if (!verifies_on_other_half(verification, settings, estimate)) return estimate;
  // A block is below the level if all its values are.
  const auto level = [&](const ExtremeDistribution& d) {
    return d.quantile(std::pow(1 - settings.exceedance, settings.block));
  };
  estimate.level = level(estimate.distribution);
  add_interval(settings, estimate, fit_maxima, level);
  return estimate;
}

ExtremeEstimate estimate_by_exceedances(std::span<const double> series,
                                        const ExtremeSettings& settings) {
  ExtremeEstimate estimate;
  char part[32];
  std::snprintf(part, sizeof part, "%g", 100 * settings.threshold);
  estimate.method = "values above the " + std::string(part) +
                    " % quantile, generalized Pareto by probability-weighted moments";
  if (!passes_series_tests(series, settings, estimate)) return estimate;
  const auto first = series.first(series.size() / 2);
  Values sorted(first.begin(), first.end());
  std::sort(sorted.begin(), sorted.end());
  const double threshold =
      sorted[static_cast<std::size_t>(settings.threshold * static_cast<double>(sorted.size()))];
  const auto above = [&](std::span<const double> values) {
    Values kept;
    std::copy_if(values.begin(), values.end(), std::back_inserter(kept),
                 [&](double x) { return x > threshold; });
    return kept;
  };
  const Values fitted = above(first), verification = above(series.subspan(series.size() / 2));
  estimate.fitted = fitted.size();
  estimate.verified = verification.size();
  if (too_few_distinct(fitted, estimate)) return estimate;
  estimate.distribution = fit_exceedances(fitted, threshold);
  if (!verifies_on_other_half(verification, settings, estimate)) return estimate;
  // Coles 2001, eq. (4.12): probability of exceeding the threshold, times that of exceeding the
  // level.
  const double beyond = static_cast<double>(fitted.size()) / static_cast<double>(first.size());
  const auto level = [&](const ExtremeDistribution& d) {
    return d.quantile(1 - settings.exceedance / beyond);
  };
  estimate.level = level(estimate.distribution);
  add_interval(
      settings, estimate, [&](const Values& values) { return fit_exceedances(values, threshold); },
      level);
  return estimate;
}

}  // namespace glint
