// How late an activation may be that has not been seen yet: an estimate, never a bound.
//
// Only where the series may be taken for independent draws from one distribution, and only where
// the half it was not fitted on agrees. Everything else is refused with the reason in words.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "platform/budget/estimate/extreme_fit.hpp"

namespace glint {

struct ExtremeSettings {
  double level = 0.01;       // of each test: one good series in a hundred is refused by each
  int lags = 20;             // Ljung-Box
  int block = 50;            // values a maximum is taken of
  int blocks_least = 30;     // in each half
  double threshold = 0.95;   // of exceedances: this part of the fitted half lies below
  double exceedance = 1e-6;  // per activation, of the level that is given
  int resamples = 400;       // of the parametric bootstrap of the level's interval
  double interval = 0.95;    // its coverage
  // From here on the fit's moments have no limit distribution. Hosking, Wallis and Wood 1985,
  // section 4: their k > -0.5.
  double shape_most = 0.5;
  double widest = 2;  // high over low of an interval that still says something
};

struct TestResult {
  std::string name;
  std::string assumption;  // what a small p refuses
  double p = 0;
  bool passed = false;
};

struct ExtremeEstimate {
  std::string method;  // in words, with its settings
  bool applicable = false;
  std::string why;  // not applicable because
  std::size_t values = 0;
  std::size_t fitted = 0, judged = 0;  // maxima, or exceedances, in each half
  ExtremeDistribution distribution;
  double level = 0, low = 0, high = 0;  // exceeded with settings.exceedance an activation
  std::vector<TestResult> tests;
  std::vector<double> judged_values;  // sorted: for a quantile plot against the distribution
};

// Values in the order in which they were taken. Block maxima with GEV, and the values above a
// threshold with the generalized Pareto distribution.
[[nodiscard]] ExtremeEstimate estimate_by_maxima(std::span<const double> series,
                                                 const ExtremeSettings& settings = {});
[[nodiscard]] ExtremeEstimate estimate_by_exceedances(std::span<const double> series,
                                                      const ExtremeSettings& settings = {});

}  // namespace glint
