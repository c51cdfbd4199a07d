// Extreme-value estimate of response times beyond those observed: an estimate, not a bound.
//
// Requires a series of independent draws from one distribution, and a half not used in the fit that
// agrees with it. Rejects all other series, with the reason as text.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "platform/budget/estimate/extreme_fit.hpp"

namespace glint {

struct ExtremeSettings {
  double significance = 0.01;  // significance level of each test
  int lags = 20;               // Ljung-Box
  int block = 50;              // block length of the maxima
  int blocks_min = 30;         // in each half
  double threshold = 0.95;     // quantile of the fitted half used as threshold
  double exceedance = 1e-6;    // probability per activation of the estimated level
  int resamples = 400;         // of the parametric bootstrap of the level's interval
  double interval = 0.95;      // its coverage
  // From this shape on, the fit's moments have no limit distribution. Hosking, Wallis and Wood
  // 1985, section 4: their k > -0.5.
  double shape_max = 0.5;
  double interval_ratio_max = 2;  // maximum high / low of a useful interval
};

struct TestResult {
  std::string name;
  std::string assumption;  // rejected if p is small
  double p = 0;
  bool passed = false;
};

struct ExtremeEstimate {
  std::string method;  // as text, with its settings
  bool applicable = false;
  std::string reason;  // reason if not applicable
  std::size_t values = 0;
  std::size_t fitted = 0, verified = 0;  // maxima, or exceedances, in each half
  ExtremeDistribution distribution;
  double level = 0, low = 0, high = 0;  // exceedance probability settings.exceedance per activation
  std::vector<TestResult> tests;
  std::vector<double> verification_values;  // sorted; for a quantile plot against the distribution
};

// `series` in the order of observation. Block maxima with the GEV distribution, and threshold
// exceedances with the generalized Pareto distribution.
[[nodiscard]] ExtremeEstimate estimate_by_maxima(std::span<const double> series,
                                                 const ExtremeSettings& settings = {});
[[nodiscard]] ExtremeEstimate estimate_by_exceedances(std::span<const double> series,
                                                      const ExtremeSettings& settings = {});

}  // namespace glint
