// Extreme-value distributions (GEV, Gumbel, generalized Pareto), fitted by probability-weighted
// moments.
//
// Shape in Coles' sign: positive: heavy tail; zero: Gumbel (or exponential); negative: bounded
// tail. Source of the forms: Coles 2001, An introduction to statistical modeling of extreme values,
// eq. (3.2) for maxima, eq. (4.2) for exceedances.
#pragma once

#include <span>

namespace glint {

struct ExtremeDistribution {
  enum class Family { maxima, exceedances };
  Family family = Family::maxima;
  double location = 0;  // of exceedances: the threshold
  double scale = 1;
  double shape = 0;

  [[nodiscard]] double cumulative(double x) const;
  // Value exceeded with probability 1 - p. Coles 2001, eq. (3.4); the inverse of (4.2).
  [[nodiscard]] double quantile(double p) const;
};

// Fits the generalized extreme-value distribution to maxima. Source: Hosking, Wallis and Wood 1985,
// Estimation of the generalized extreme-value distribution by the method of probability-weighted
// moments, eq. (14) and the two after it; b_r as in its eq. (6). Their k is minus our shape.
[[nodiscard]] ExtremeDistribution fit_maxima(std::span<const double> maxima);

// The same with shape zero. Source: Landwehr, Matalas and Wallis 1979, Probability weighted moments
// compared with some traditional techniques in estimating Gumbel parameters and quantiles.
[[nodiscard]] ExtremeDistribution fit_gumbel(std::span<const double> maxima);

// Fits the generalized Pareto distribution to the values above a threshold. Source: Hosking and
// Wallis 1987, Parameter and quantile estimation for the generalized Pareto distribution, section
// 4.
[[nodiscard]] ExtremeDistribution fit_exceedances(std::span<const double> values, double threshold);

// Kolmogorov-Smirnov test that the values are draws from the distribution (fitted to others);
// p-value.
[[nodiscard]] double kolmogorov_smirnov_p(std::span<const double> values,
                                          const ExtremeDistribution& distribution);

}  // namespace glint
