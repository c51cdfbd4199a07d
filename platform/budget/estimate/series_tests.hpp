// Tests of independence and stationarity of a series of times.
//
// Each returns a p-value: the probability of a series at least this far from the assumption, if the
// assumption holds. A small value rejects the assumption.
#pragma once

#include <span>

namespace glint {

// Autocorrelation up to `lags`; requires an even number. Source: Ljung and Box 1978, On a measure
// of lack of fit in time series models, eq. (1.3), Q against chi-squared with `lags` degrees of
// freedom.
[[nodiscard]] double ljung_box(std::span<const double> series, int lags);

// Runs above and below the median, two-sided. Source: Wald and Wolfowitz 1940, On a test whether
// two samples are from the same population; the normal limit of section 4.
[[nodiscard]] double runs_test(std::span<const double> series);

// Monotone trend, two-sided, with the correction for ties. Source: Mann 1945, Nonparametric tests
// against trend; Kendall 1975, Rank correlation methods, chapter 4.
[[nodiscard]] double mann_kendall(std::span<const double> series);

// Equal distributions of both halves of the series: two-sample Kolmogorov-Smirnov.
[[nodiscard]] double two_halves_p(std::span<const double> series);

// Tail of the Kolmogorov distribution at distance d of n values (two samples: n m / (n + m)).
// Source: Stephens 1970, Use of the Kolmogorov-Smirnov, Cramer-von Mises and related statistics
// without extensive tables, the factor sqrt(n) + 0.12 + 0.11 / sqrt(n).
[[nodiscard]] double kolmogorov_p(double d, double n);

// 2 (1 - Phi(|z|)).
[[nodiscard]] double two_sided_normal_p(double z);

}  // namespace glint
