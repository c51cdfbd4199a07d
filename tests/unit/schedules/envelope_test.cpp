#include "schedules/envelope.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace glint {
namespace {

double bound_of(const Envelope& envelope, const EnvelopeProblem& problem) {
  double sum = 0;
  for (std::size_t j = 0; j < graph::k_loops_max; ++j) sum += envelope.cost[j] * problem.weight[j];
  return sum;
}

// Calls whose cost is exactly the scalar product of their counts and these costs.
std::vector<ObservedCall> exact_calls(int how_many, double call, double run, double pixel) {
  std::mt19937 random(1);
  std::vector<ObservedCall> calls;
  for (int i = 0; i < how_many; ++i) {
    const std::int64_t runs = random() % 1000;
    const std::int64_t pixels = random() % 200'000;
    calls.push_back({{{1, runs, pixels}},
                     call + run * static_cast<double>(runs) + pixel * static_cast<double>(pixels)});
  }
  return calls;
}

TEST(Envelope, FindsTheCostsThatCallsWereMadeFrom) {
  const auto calls = exact_calls(5000, 120, 7.5, 0.25);
  const ProblemSize size{{{1, 1000, 200'000}}, 57'620};
  const LoopWeights weights = balanced_weights(calls, std::span(&size, 1));
  const Envelope envelope = fit_envelope({calls, weights, 3, 0});
  ASSERT_TRUE(envelope) << name_of(envelope.fault);
  EXPECT_NEAR(envelope.cost[0], 120, 0.01);
  EXPECT_NEAR(envelope.cost[1], 7.5, 1e-4);
  EXPECT_NEAR(envelope.cost[2], 0.25, 1e-6);
}

// Either loop can carry the call's cost. The first is slightly more expensive for the large
// problem, the second ten times as expensive for the small one.
TEST(Envelope, ASmallProblemsBoundCountsAsMuchAsALargeOnes) {
  const std::array<ObservedCall, 1> calls = {{{{{1, 1}}, 1}}};
  const std::array<ProblemSize, 2> sizes = {{{{{1000, 980}}, 1000}, {{{1, 10}}, 1}}};
  const Envelope envelope = fit_envelope({calls, balanced_weights(calls, sizes), 2, 0});
  ASSERT_TRUE(envelope) << name_of(envelope.fault);
  EXPECT_NEAR(envelope.cost[0], 1, 1e-9);
  EXPECT_NEAR(envelope.cost[1], 0, 1e-9);
}

TEST(Envelope, WidensEveryCostByTheDeclaredMargin) {
  const auto calls = exact_calls(100, 120, 7.5, 0.25);
  const Envelope tight = fit_envelope({calls, {1, 1000, 200'000}, 3, 0});
  const Envelope wide = fit_envelope({calls, {1, 1000, 200'000}, 3, 0.05});
  for (std::size_t j = 0; j < 3; ++j) EXPECT_DOUBLE_EQ(wide.cost[j], tight.cost[j] * 1.05);
}

TEST(Envelope, NoCallOfTheFitCostsMoreThanItSays) {
  std::mt19937 random(2);
  for (int trial = 0; trial < 50; ++trial) {
    auto calls = exact_calls(2000, 100, 5, 0.1);
    for (ObservedCall& call : calls) call.cost *= 1 + static_cast<double>(random() % 1000) / 5000;
    const Envelope envelope = fit_envelope({calls, {1, 1000, 200'000}, 3, 0});
    ASSERT_TRUE(envelope) << name_of(envelope.fault);
    const EnvelopeValidation validation = validate(envelope, calls);
    EXPECT_EQ(validation.above, 0) << validation.worst_excess_percent;
    for (std::size_t j = 0; j < 3; ++j) EXPECT_GE(envelope.cost[j], 0);
  }
}

TEST(Envelope, NoGridPointWithinTheConstraintsHasASmallerBound) {
  std::mt19937 random(3);
  std::vector<ObservedCall> calls;
  for (int i = 0; i < 40; ++i) {
    calls.push_back({{{1, static_cast<std::int64_t>(random() % 20)}},
                     static_cast<double>(50 + random() % 100)});
  }
  const EnvelopeProblem problem{calls, {1, 20}, 2, 0};
  const Envelope envelope = fit_envelope(problem);
  ASSERT_TRUE(envelope);
  double grid_min = std::numeric_limits<double>::infinity();
  for (double call = 0; call <= 200; call += 0.5) {
    for (double loop = 0; loop <= 20; loop += 0.05) {
      Envelope point;
      point.cost = {call, loop};
      if (validate(point, calls).above == 0)
        grid_min = std::min(grid_min, bound_of(point, problem));
    }
  }
  EXPECT_LE(bound_of(envelope, problem), grid_min + 1e-6);
  EXPECT_GE(bound_of(envelope, problem), grid_min - 2);  // the grid's step
}

TEST(Envelope, ABoundAtCountsThatWereSeenIsWhatWasSeenThere) {
  auto calls = exact_calls(500, 100, 5, 0.1);
  calls.push_back({{{1, 1000, 200'000}}, 30'000});
  const EnvelopeProblem problem{calls, {1, 1000, 200'000}, 3, 0};
  EXPECT_NEAR(bound_of(fit_envelope(problem), problem), 30'000, 0.1);
}

TEST(Envelope, LoopsThatAlwaysRunEquallyOftenShareTheirCost) {
  std::vector<ObservedCall> calls;
  for (int i = 0; i < 100; ++i) {
    calls.push_back({{{1, 16, 16, i % 10, 0}}, 500.0 + i % 10});
  }
  const EnvelopeProblem problem{calls, {1, 16, 16, 9, 0}, 5, 0};
  const Envelope envelope = fit_envelope(problem);
  ASSERT_TRUE(envelope) << name_of(envelope.fault);
  EXPECT_NEAR(bound_of(envelope, problem), 509, 1e-6);
  EXPECT_EQ(validate(envelope, calls).above, 0);
}

TEST(Envelope, EqualCallsEndWithinTheDeclaredPivots) {
  const std::vector<ObservedCall> calls(10'000, ObservedCall{{{1, 3, 3, 3, 3, 3, 3, 3}}, 77});
  const Envelope envelope = fit_envelope({calls, {1, 3, 3, 3, 3, 3, 3, 3}, 8, 0});
  ASSERT_TRUE(envelope) << name_of(envelope.fault);
  EXPECT_LT(envelope.pivots, 100);
  EXPECT_NEAR(cost_of(envelope, calls[0].counts), 77, 1e-9);
}

TEST(Envelope, ALoopThatNeverRanCostsNothing) {
  const std::vector<ObservedCall> calls(10, ObservedCall{{{1, 0}}, 40});
  const Envelope envelope = fit_envelope({calls, {1, 100}, 2, 0});
  ASSERT_TRUE(envelope);
  EXPECT_EQ(envelope.cost[1], 0);
}

TEST(Envelope, SaysThatNothingWasSeen) {
  EXPECT_EQ(fit_envelope({{}, {1}, 1, 0}).fault, EnvelopeFault::no_calls);
}

TEST(Envelope, SaysThatACallCostsSomethingAlthoughNoLoopRan) {
  const std::vector<ObservedCall> calls = {{{{0, 0}}, 40}};
  EXPECT_EQ(fit_envelope({calls, {1, 100}, 2, 0}).fault, EnvelopeFault::cost_without_counts);
}

TEST(Envelope, NamesEachFault) {
  EXPECT_EQ(name_of(EnvelopeFault::none), "none");
  EXPECT_EQ(name_of(EnvelopeFault::no_calls), "no calls");
  EXPECT_EQ(name_of(EnvelopeFault::cost_without_counts), "a call costs something, but no loop ran");
  EXPECT_EQ(name_of(EnvelopeFault::pivots_exhausted), "no optimum within the declared pivots");
}

TEST(Envelope, IsJudgedOnCallsThatItHasNotSeen) {
  Envelope envelope;
  envelope.cost = {100, 1};
  const std::vector<ObservedCall> unseen = {
      {{{1, 0}}, 100}, {{{1, 100}}, 220}, {{{1, 100}}, 100}, {{{1, 0}}, 101}};
  const EnvelopeValidation validation = validate(envelope, unseen);
  EXPECT_EQ(validation.calls, 4);
  EXPECT_EQ(validation.above, 2);
  EXPECT_NEAR(validation.worst_excess_percent, 10, 1e-9);
}

}  // namespace
}  // namespace glint
