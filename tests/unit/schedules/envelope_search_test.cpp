// Simplex search for a cost envelope: pivots, stalls, scaling, and the weights of its objective.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "schedules/envelope.hpp"

namespace glint::envelope_search_test {
namespace {

constexpr int k_loops = 6;

std::vector<ObservedCall> random_calls(std::mt19937& random, int how_many) {
  std::vector<ObservedCall> calls;
  for (int i = 0; i < how_many; ++i) {
    ObservedCall call;
    call.counts[0] = 1;
    call.cost = 100;
    for (std::size_t j = 1; j < k_loops; ++j) {
      call.counts[j] = static_cast<std::int64_t>(random() % 40);
      call.cost += static_cast<double>(call.counts[j]) * static_cast<double>(1 + random() % 20);
    }
    calls.push_back(call);
  }
  return calls;
}

double bound_of(const Envelope& envelope, const LoopWeights& weight) {
  double sum = 0;
  for (std::size_t j = 0; j < graph::k_loops_max; ++j) sum += envelope.cost[j] * weight[j];
  return sum;
}

TEST(EnvelopeSearch, EndsWithAFaultAfterThePivotsThatItIsGiven) {
  std::mt19937 random(5);
  const std::vector<ObservedCall> calls = random_calls(random, 200);
  EnvelopeProblem problem{calls, {1, 20, 20, 20, 20, 20}, k_loops, 0};
  const Envelope found = fit_envelope(problem);
  ASSERT_TRUE(found);
  ASSERT_GT(found.pivots, 2);
  problem.pivots_max = found.pivots + 1;  // the last step finds no improvement
  EXPECT_EQ(fit_envelope(problem).fault, EnvelopeFault::none);
  EXPECT_EQ(fit_envelope(problem).cost, found.cost);
  problem.pivots_max = found.pivots;
  const Envelope cut = fit_envelope(problem);
  EXPECT_EQ(cut.fault, EnvelopeFault::pivots_exhausted);
  EXPECT_EQ(cut.pivots, found.pivots);
  EXPECT_EQ(cut.cost, (decltype(cut.cost){})) << "costs of no optimum are none";
}

// Weights of one loop alone: most pivots are degenerate. Both pivot rules end at one bound.
TEST(EnvelopeSearch, EndsAtTheSameBoundByBlandsRule) {
  std::mt19937 random(6);
  for (int trial = 0; trial < 30; ++trial) {
    const std::vector<ObservedCall> calls = random_calls(random, 60);
    LoopWeights weight{};
    for (int j = 0; j <= trial % 3; ++j) weight[random() % k_loops] = 1;
    EnvelopeProblem problem{calls, weight, k_loops, 0};
    const Envelope by_gain = fit_envelope(problem);
    problem.stalls_max = -1;  // from the first pivot on
    const Envelope by_order = fit_envelope(problem);
    ASSERT_TRUE(by_gain && by_order) << trial;
    EXPECT_EQ(validate(by_order, calls).above, 0) << trial;
    const double bound = bound_of(by_gain, weight);
    EXPECT_NEAR(bound_of(by_order, weight), bound, 1e-6 * (1 + bound)) << trial;
  }
}

TEST(EnvelopeSearch, CoversEveryCallWhereNoCountMatters) {
  std::mt19937 random(7);
  const std::vector<ObservedCall> calls = random_calls(random, 60);
  const Envelope envelope = fit_envelope({calls, {}, k_loops, 0});
  ASSERT_TRUE(envelope) << name_of(envelope.fault);
  EXPECT_EQ(validate(envelope, calls).above, 0);
  for (const double cost : envelope.cost) EXPECT_GE(cost, 0);
}

TEST(EnvelopeSearch, OfCallsThatCostNothingIsNothing) {
  std::mt19937 random(8);
  std::vector<ObservedCall> calls = random_calls(random, 10);
  for (ObservedCall& call : calls) call.cost = 0;
  const Envelope envelope = fit_envelope({calls, {1, 1, 1, 1, 1, 1}, k_loops, 0});
  ASSERT_TRUE(envelope);
  EXPECT_EQ(envelope.pivots, 0);
  EXPECT_EQ(envelope.cost, (decltype(envelope.cost){}));
}

// Seconds instead of nanoseconds, and counts or weights a million times as large.
TEST(EnvelopeSearch, DoesNotDependOnAnyUnit) {
  std::mt19937 random(9);
  const std::vector<ObservedCall> calls = random_calls(random, 100);
  const LoopWeights weight = {1, 20, 20, 20, 20, 20};
  const Envelope plain = fit_envelope({calls, weight, k_loops, 0});
  ASSERT_TRUE(plain);
  constexpr double k_unit = 1e-12;
  constexpr std::int64_t k_million = 1'000'000;
  std::vector<ObservedCall> small = calls, large = calls;
  LoopWeights heavy = weight;
  for (ObservedCall& call : small) call.cost *= k_unit;
  for (ObservedCall& call : large) call.counts[2] *= k_million;
  for (double& w : heavy) w *= 1e12;
  const Envelope by_cost = fit_envelope({small, weight, k_loops, 0});
  const Envelope by_weight = fit_envelope({calls, heavy, k_loops, 0});
  LoopWeights counted = weight;
  counted[2] *= k_million;
  const Envelope by_count = fit_envelope({large, counted, k_loops, 0});
  ASSERT_TRUE(by_cost && by_weight && by_count);
  const double near = 1e-9 * *std::max_element(plain.cost.begin(), plain.cost.end());
  for (std::size_t j = 0; j < k_loops; ++j) {
    EXPECT_NEAR(by_cost.cost[j], plain.cost[j] * k_unit, near * k_unit) << j;
    EXPECT_NEAR(by_weight.cost[j], plain.cost[j], near) << j;
    const double one = j == 2 ? double{k_million} : 1;
    EXPECT_NEAR(by_count.cost[j] * one, plain.cost[j], near) << j;
  }
}

TEST(EnvelopeSearch, UsesNoLoopBeyondItsOwn) {
  const std::vector<ObservedCall> calls = {{{{1, 10, 1'000}}, 50}, {{{1, 20, 2'000}}, 60}};
  const Envelope envelope = fit_envelope({calls, {1, 15, 1}, 2, 0});
  ASSERT_TRUE(envelope);
  EXPECT_NEAR(envelope.cost[0], 40, 1e-9);
  EXPECT_NEAR(envelope.cost[1], 1, 1e-9);
  EXPECT_EQ(envelope.cost[2], 0);
}

// From calls: the mean of counts over cost. From problem sizes: the sum.
TEST(BalancedWeights, AreShareOfCostAtSizesAndOnAverageAtCalls) {
  const std::vector<ObservedCall> calls = {
      {{{1, 8}}, 4}, {{{1, 6}}, 2}, {{{1, 100}}, 0}, {{{1, 100}}, -1}};
  const std::vector<ProblemSize> sizes = {{{{2, 30}}, 10}, {{{2, 50}}, 5}, {{{7, 7}}, 0}};
  const LoopWeights weights = balanced_weights(calls, sizes);
  EXPECT_DOUBLE_EQ(weights[0], (1.0 / 4 + 1.0 / 2) / 4 + 2.0 / 10 + 2.0 / 5);
  EXPECT_DOUBLE_EQ(weights[1], (8.0 / 4 + 6.0 / 2) / 4 + 30.0 / 10 + 50.0 / 5);
  EXPECT_EQ(weights[2], 0);
  EXPECT_EQ(balanced_weights({}, {}), LoopWeights{});
}

TEST(CostOf, IsTheSumOfCountsTimesCosts) {
  Envelope envelope;
  graph::LoopCounts counts;
  double sum = 0;
  for (std::size_t j = 0; j < graph::k_loops_max; ++j) {
    envelope.cost[j] = 1.0 + static_cast<double>(j);
    counts[j] = static_cast<std::int64_t>(10 * j + 3);
    sum += envelope.cost[j] * static_cast<double>(counts[j]);
  }
  EXPECT_DOUBLE_EQ(cost_of(envelope, counts), sum);
}

TEST(Judge, CountsAnyCostWhereTheEnvelopeStatesNoneAsTwice) {
  const std::vector<ObservedCall> calls = {{{{1}}, 5}, {{{1}}, 0}};
  const EnvelopeValidation validation = validate(Envelope{}, calls);
  EXPECT_EQ(validation.calls, 2);
  EXPECT_EQ(validation.above, 1);
  EXPECT_EQ(validation.worst_excess_percent, 100);
}

}  // namespace
}  // namespace glint::envelope_search_test
