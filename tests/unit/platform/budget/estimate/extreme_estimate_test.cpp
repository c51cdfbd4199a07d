#include "platform/budget/estimate/extreme_estimate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "platform/budget/estimate/series_tests.hpp"

namespace glint {
namespace {

constexpr std::size_t k_many = 10'000;

class Draws {
 public:
  explicit Draws(std::uint64_t seed) : random_(seed) {}
  double uniform() { return (static_cast<double>(random_() >> 11) + 0.5) * 0x1p-53; }
  double gumbel(double location, double scale) {
    return location - scale * std::log(-std::log(uniform()));
  }
  double normal() {
    return std::sqrt(-2 * std::log(uniform())) * std::cos(2 * 3.14159265358979 * uniform());
  }

  template <class Draw>
  std::vector<double> series(std::size_t count, Draw&& draw) {
    std::vector<double> values;
    for (std::size_t i = 0; i < count; ++i) values.push_back(draw(i));
    return values;
  }

 private:
  std::mt19937_64 random_;
};

std::vector<double> gumbel_series(std::uint64_t seed) {
  Draws draws(seed);
  return draws.series(k_many, [&](std::size_t) { return draws.gumbel(100, 5); });
}

// Level with exceedance probability 1e-6: -ln(-ln(1 - 1e-6)) scales above the location.
const double k_true_level = 100 - 5 * std::log(-std::log1p(-1e-6));

TEST(ExtremeEstimate, FindsTheLevelOfAKnownDistributionWithinItsInterval) {
  int refused = 0, applicable = 0, inside = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const ExtremeEstimate estimate = estimate_by_maxima(gumbel_series(seed), {.resamples = 200});
    const bool open = estimate.reason.find("do not determine the level") != std::string::npos;
    refused += !estimate.applicable && !open ? 1 : 0;
    if (!estimate.applicable) continue;
    ++applicable;
    inside += estimate.low <= k_true_level && k_true_level <= estimate.high ? 1 : 0;
  }
  EXPECT_LE(refused, 9);  // 4 expected: six tests at 1 % reject at most 6 % of valid series
  EXPECT_GE(applicable, 40);
  EXPECT_GE(inside, applicable * 85 / 100);
}

TEST(ExtremeEstimate, FindsTheSameLevelByExceedances) {
  int refused = 0, applicable = 0, inside = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const ExtremeEstimate estimate =
        estimate_by_exceedances(gumbel_series(seed), {.resamples = 200});
    const bool open = estimate.reason.find("do not determine the level") != std::string::npos;
    refused += !estimate.applicable && !open ? 1 : 0;
    if (!estimate.applicable) continue;
    ++applicable;
    inside += estimate.low <= k_true_level && k_true_level <= estimate.high ? 1 : 0;
  }
  EXPECT_LE(refused, 9);
  EXPECT_GE(applicable, 40);
  EXPECT_GE(inside, applicable * 80 / 100);
}

TEST(ExtremeEstimate, RefusesTimesThatRememberTheOneBefore) {
  Draws draws(7);
  double last = 0;
  const auto series = draws.series(k_many, [&](std::size_t) {
    last = 0.3 * last + draws.normal();
    return 100 + last;
  });
  const ExtremeEstimate estimate = estimate_by_maxima(series);
  EXPECT_FALSE(estimate.applicable);
  EXPECT_NE(estimate.reason.find("not independent (Ljung-Box"), std::string::npos)
      << estimate.reason;
}

TEST(ExtremeEstimate, RefusesTimesThatGrow) {
  Draws draws(8);
  const auto series = draws.series(
      k_many, [&](std::size_t i) { return draws.gumbel(100, 5) + 1e-4 * static_cast<double>(i); });
  const ExtremeEstimate estimate = estimate_by_maxima(series);
  EXPECT_FALSE(estimate.applicable);
  EXPECT_NE(estimate.reason.find("not stationary"), std::string::npos) << estimate.reason;
}

TEST(ExtremeEstimate, RefusesTwoModesThatTakeTurns) {
  Draws draws(9);
  bool slow = false;
  const auto series = draws.series(k_many, [&](std::size_t) {
    if (draws.uniform() < 0.02) slow = !slow;
    return draws.gumbel(slow ? 130 : 100, 5);
  });
  EXPECT_FALSE(estimate_by_maxima(series).applicable);
  EXPECT_FALSE(estimate_by_exceedances(series).applicable);
}

// Independent values: only the second half shows that no single distribution of maxima fits.
TEST(ExtremeEstimate, RefusesARareModeFarOutBecauseTheOtherHalfDisagrees) {
  Draws draws(10);
  const auto series = draws.series(40'000, [&](std::size_t) {
    return draws.uniform() < 0.014 ? 400 + draws.uniform() : draws.gumbel(100, 5);
  });
  const ExtremeEstimate estimate = estimate_by_maxima(series);
  EXPECT_FALSE(estimate.applicable);
  EXPECT_NE(estimate.reason.find("fails on the other"), std::string::npos) << estimate.reason;
}

// One outlier in five thousand values leaves the tail unbounded.
TEST(ExtremeEstimate, RefusesALevelThatTheValuesLeaveOpen) {
  auto series = gumbel_series(14);
  series[1234] = 2000;
  const ExtremeEstimate estimate = estimate_by_maxima(series);
  EXPECT_FALSE(estimate.applicable);
  EXPECT_FALSE(estimate.reason.empty());
}

TEST(ExtremeEstimate, SaysHowManyValuesItNeeds) {
  Draws draws(11);
  const auto series = draws.series(812, [&](std::size_t) { return draws.gumbel(100, 5); });
  EXPECT_EQ(estimate_by_maxima(series).reason,
            "812 values; at least 3000 are needed (two halves of 30 blocks of 50)");
}

TEST(ExtremeEstimate, RefusesCountsThatHardlyVary) {
  Draws draws(12);
  const auto series =
      draws.series(k_many, [&](std::size_t) { return std::floor(3 * draws.uniform()); });
  EXPECT_NE(estimate_by_maxima(series).reason.find("different values among"), std::string::npos);
}

TEST(ExtremeFit, RecoversAHeavyAndAnEndingTail) {
  Draws draws(13);
  for (const double shape : {-0.2, 0.2}) {
    const ExtremeDistribution truth{ExtremeDistribution::Family::maxima, 50, 4, shape};
    const auto maxima =
        draws.series(20'000, [&](std::size_t) { return truth.quantile(draws.uniform()); });
    const ExtremeDistribution fit = fit_maxima(maxima);
    EXPECT_NEAR(fit.location, 50, 0.15);
    EXPECT_NEAR(fit.scale, 4, 0.12);
    EXPECT_NEAR(fit.shape, shape, 0.03);
    const ExtremeDistribution beyond{ExtremeDistribution::Family::exceedances, 10, 3, shape};
    const auto values =
        draws.series(20'000, [&](std::size_t) { return beyond.quantile(draws.uniform()); });
    const ExtremeDistribution pareto = fit_exceedances(values, 10);
    EXPECT_NEAR(pareto.scale, 3, 0.12);
    EXPECT_NEAR(pareto.shape, shape, 0.03);
  }
}

TEST(ExtremeFit, GivesBackTheProbabilityOfItsOwnQuantile) {
  for (const double shape : {-0.3, 0.0, 0.4}) {
    for (const auto family :
         {ExtremeDistribution::Family::maxima, ExtremeDistribution::Family::exceedances}) {
      const ExtremeDistribution d{family, 7, 2, shape};
      for (const double p : {0.01, 0.5, 0.999}) EXPECT_NEAR(d.cumulative(d.quantile(p)), p, 1e-12);
    }
  }
}

// A test at significance level 1 % rejects about 1 % of valid series, neither many more nor none.
TEST(SeriesTests, RefuseAsManyGoodSeriesAsTheyClaim) {
  int refused[4] = {};
  constexpr int trials = 2000;
  for (int trial = 0; trial < trials; ++trial) {
    Draws draws(1000 + static_cast<std::uint64_t>(trial));
    const auto series = draws.series(400, [&](std::size_t) { return draws.normal(); });
    refused[0] += ljung_box(series, 20) < 0.01 ? 1 : 0;
    refused[1] += runs_test(series) < 0.01 ? 1 : 0;
    refused[2] += mann_kendall(series) < 0.01 ? 1 : 0;
    refused[3] += two_halves_p(series) < 0.01 ? 1 : 0;
  }
  for (const int count : refused) {
    EXPECT_GE(count, 5);  // 20 expected; binomial, four standard deviations
    EXPECT_LE(count, 40);
  }
}

// Mann 1945: S of a short series by hand. 9 of 10 pairs rise, so S = 8, var = 50 / 3.
TEST(SeriesTests, CountTheRisingPairsOfAShortSeries) {
  const double series[] = {1, 2, 4, 3, 5};
  EXPECT_NEAR(mann_kendall(series), two_sided_normal_p(7 / std::sqrt(50.0 / 3)), 1e-12);
}

// Tabulated 5 % and 1 % points of the limit distribution.
TEST(SeriesTests, KnowTheKolmogorovDistributionsTable) {
  const double n = 1e6, scale = std::sqrt(n) + 0.12 + 0.11 / std::sqrt(n);
  EXPECT_NEAR(kolmogorov_p(1.3581 / scale, n), 0.05, 1e-4);
  EXPECT_NEAR(kolmogorov_p(1.6276 / scale, n), 0.01, 1e-4);
}

}  // namespace
}  // namespace glint
