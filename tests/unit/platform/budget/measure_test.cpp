// Measures a kernel of known work with the real programs. glint_measure_toy is glint_measure with
// that kernel instead of Glint's own.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "platform/budget/measure/cost_fit.hpp"
#include "platform/budget/measure/measure_result.hpp"
#include "platform/budget/measure/measured_limits.hpp"
#include "platform/input_error.hpp"
#include "tests/unit/beside_test.hpp"

namespace glint {
namespace {

MeasureRequest toy_request() {
  MeasureRequest request;
  request.program = path_beside_test("glint_measure_toy");
  request.emulator = "qemu-x86_64";
  request.cpu_model = "qemu64";
  request.plugin = path_beside_test("glint_count_instructions.so");
  request.inputs = 400;
  return request;
}

Observations observed(const MeasureRequest& request) {
  return measure(request, [](int, int) {});
}

TEST(InputNumbers, ShareEveryTwentyAndAlternateBetweenTheLimits) {
  int kinds[4] = {};
  for (std::uint64_t i = 0; i < 20; ++i) ++kinds[static_cast<int>(input_of(i).kind)];
  EXPECT_EQ(kinds[0], 12);
  EXPECT_EQ(kinds[1], 4);
  EXPECT_EQ(kinds[2], 2);
  EXPECT_EQ(kinds[3], 2);
  EXPECT_EQ(input_of(19).limits, 0u);
  EXPECT_EQ(input_of(20).limits, 1u);
}

TEST(InputNumbers, NeverTakeAnInputTwice) {
  std::set<std::tuple<int, std::uint64_t, std::uint64_t>> seen;
  for (std::uint64_t i = 0; i < 10'000; ++i) {
    const MeasuredInput input = input_of(i);
    EXPECT_TRUE(seen.insert({static_cast<int>(input.kind), input.number, input.limits}).second);
  }
}

TEST(InputNumbers, PutHalfOfEveryKindIntoEachHalf) {
  for (std::uint64_t limits = 0; limits < k_limit_sets; ++limits) {
    for (int kind = 0; kind < 4; ++kind) {
      int fitted = 0;
      for (std::uint64_t number = 0; number < 1000; ++number) {
        fitted += is_in_fit_half({static_cast<InputKind>(kind), number, limits}) ? 1 : 0;
      }
      EXPECT_NEAR(fitted, 500, 80) << kind;  // five standard deviations of a fair coin
    }
  }
}

#if GLINT_CAN_COUNT
TEST(CountInstructions, GivesTheSameNumbersTwice) {
  const Observations first = observed(toy_request());
  const Observations second = observed(toy_request());
  ASSERT_EQ(first.kernels.size(), 1u);
  ASSERT_EQ(first.kernels[0].calls.size(), 400u);
  for (std::size_t i = 0; i < 400; ++i) {
    EXPECT_EQ(first.kernels[0].calls[i].call.cost, second.kernels[0].calls[i].call.cost);
    EXPECT_EQ(first.kernels[0].calls[i].call.counts, second.kernels[0].calls[i].call.counts);
  }
}

TEST(CountInstructions, CountsExactlyWhatALoopAdds) {
  const auto& calls = observed(toy_request()).kernels.at(0).calls;
  const auto cost_at = [&](std::int64_t steps) {
    for (const Observation& seen : calls) {
      if (seen.call.counts[1] == steps) return seen.call.cost;
    }
    return -1.0;
  };
  const double none = cost_at(0);
  const double cell = cost_at(64);
  const double cost_max_steps = cost_at(256);
  ASSERT_GE(none, 0);
  // A step costs a constant whole number of instructions in a long loop.
  const double step = (cost_max_steps - cell) / (256 - 64);
  EXPECT_EQ(step, static_cast<double>(static_cast<int>(step)));
  EXPECT_GE(step, 3);  // load, compute, store
  EXPECT_LT(cell - none - 64 * step, 10);
}

TEST(CountInstructions, FindsTheEnvelopeOfAKernelWhoseCostIsExact) {
  const KernelObservations toy = observed(toy_request()).kernels.at(0);
  const MeasuredCosts costs = costs_of(toy, nullptr, 0);
  EXPECT_TRUE(costs.holds());
  EXPECT_NEAR(costs.at[0].ratio(), 1, 0.001);
  EXPECT_NEAR(costs.at[1].ratio(), 1, 0.01);
  EXPECT_EQ(costs.judge_half.above, 0);
  EXPECT_EQ(costs.declared[1], Limits{}.blobs);
  EXPECT_EQ(costs.observed[1], Limits{}.blobs);
}

TEST(CountInstructions, SaysWhichEmulatorIsMissing) {
  MeasureRequest request = toy_request();
  request.emulator = "qemu-no-such-machine";
  EXPECT_THROW((void)observed(request), MissingDevice);
}
#endif

TEST(Measure, TakesTimeOnThisMachine) {
  MeasureRequest request = toy_request();
  request.count_instructions = false;
  request.emulator.clear();
  const KernelObservations toy = observed(request).kernels.at(0);
  double cost_max = 0;
  for (const Observation& seen : toy.calls) cost_max = std::max(cost_max, seen.call.cost);
  EXPECT_GT(cost_max, 10);  // 256 dependent steps through memory
}

Observations pass_of(std::initializer_list<double> costs) {
  Observations pass;
  pass.kernels.emplace_back().name = "Toy";
  for (const double cost : costs) {
    pass.kernels[0].calls.push_back({{}, {{{1, 7}}, cost}});
  }
  return pass;
}

TEST(Passes, KeepTheLeastOfEachCall) {
  Observations kept = pass_of({5, 2, 9});
  keep_minimum(kept, pass_of({4, 3, 9}));
  EXPECT_EQ(kept.kernels[0].calls[0].call.cost, 4);
  EXPECT_EQ(kept.kernels[0].calls[1].call.cost, 2);
  EXPECT_EQ(kept.kernels[0].calls[2].call.cost, 9);
}

TEST(Passes, RefuseOneThatDidOtherWork) {
  Observations kept = pass_of({5, 2});
  EXPECT_THROW(keep_minimum(kept, pass_of({5})), InputError);
  EXPECT_THROW(keep_minimum(kept, {}), InputError);
  Observations other = pass_of({5, 2});
  other.kernels[0].calls[1].call.counts[1] = 8;
  EXPECT_THROW(keep_minimum(kept, other), InputError);
}

TEST(Measure, RefusesAKernelThatIsNotThereAndNamesThoseThatAre) {
  MeasureRequest request = toy_request();
  request.count_instructions = false;
  request.emulator.clear();
  request.kernel = "Tox";
  try {
    (void)observed(request);
    FAIL() << "measured";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "--kernel is \"Tox\"; expected one of Toy");
  }
}

TEST(Measure, SaysWhereNoMeasuringProgramIs) {
  MeasureRequest request = toy_request();
  request.program = "/no/such/program";
  EXPECT_THROW((void)observed(request), MissingDevice);
}

KernelObservations parsed(const std::string& text, const std::vector<std::uint64_t>& counted) {
  return parse_observations("Toy", "toy.txt", text, counted);
}
const std::string k_seen =
    "loops call steps\nworst 0 1 10\nworst 1 1 5\ninput 0 worst 3 1 10 7.5\n";

TEST(Observations, TakeTheirCostsFromTheCounterLessTheEmptyCall) {
  EXPECT_EQ(parsed(k_seen, {}).calls.at(0).call.cost, 7.5);
  EXPECT_EQ(parsed(k_seen, {9, 109}).calls.at(0).call.cost, 100);
  EXPECT_EQ(parsed(k_seen, {}).worst[1][1], 5);
}

TEST(Observations, AreRefusedWhereTheyAreNotWhole) {
  EXPECT_THROW((void)parsed(k_seen, {9, 109, 110}), InputError);
  EXPECT_THROW((void)parsed(k_seen, {9, 8}), InputError);
  EXPECT_THROW((void)parsed("loops call steps\ninput 0 worst 3 1 10\n", {}), InputError);
  EXPECT_THROW((void)parsed("loops call\ninput 0 wurst 3 1 10\n", {}), InputError);
  EXPECT_THROW((void)parsed("loops\n", {}), InputError);
  EXPECT_THROW((void)parsed("loops call\nworst 2 1\n", {}), InputError);
}

// A kernel that costs more than its board file states must fail: the bound does not hold.
TEST(CostFit, SeesACallAboveTheBoundOfABoard) {
  const KernelObservations seen = parsed(k_seen, {0, 1000});
  const std::array<std::string_view, 2> loops = {"call", "steps"};
  const BoardKernel expensive{{"Toy", loops}, {0, 100}};
  const BoardKernel inexpensive{{"Toy", loops}, {0, 99}};
  EXPECT_TRUE(costs_of(seen, &expensive, 0).holds());
  EXPECT_FALSE(costs_of(seen, &inexpensive, 0).holds());
  EXPECT_EQ(costs_of(seen, &inexpensive, 0).at[0].bound, 990);
}

TEST(CostFit, SeesALoopThatRanMoreOftenThanDeclared) {
  const KernelObservations seen =
      parsed("loops call steps\nworst 0 1 9\nworst 1 1 5\ninput 0 worst 3 1 10 7.5\n", {});
  const std::array<std::string_view, 2> loops = {"call", "steps"};
  const BoardKernel expensive{{"Toy", loops}, {0, 100}};
  EXPECT_EQ(costs_of(seen, &expensive, 0).beyond_declared, 1);
  EXPECT_FALSE(costs_of(seen, &expensive, 0).holds());
}

TEST(CostFit, MakesABoardOfEveryKernelOrNone) {
  Measurement measurement;
  const std::array<std::string_view, 2> loops = {"call", "steps"};
  BoardExpectation expected;
  expected.kernels.push_back({"Toy", loops});
  BoardRequest request;
  request.name = "toy";
  request.ns_per_instruction = 2;
  EXPECT_THROW((void)measured_board(measurement, request, expected), InputError);
  measurement.kernels.push_back(costs_of(parsed(k_seen, {0, 1000}), nullptr, 0));
  const Board board = measured_board(measurement, request, expected);
  EXPECT_EQ(bound_ns(board.costs.at(0), {{1, 10}}), 2000);
}

// A graph added to a board file is priced alone, so that no other cost changes.
TEST(CostFit, PutsOneKernelsCostsIntoABoardAndLeavesTheOthersAlone) {
  const std::array<std::string_view, 2> loops = {"call", "steps"};
  const std::array<std::string_view, 1> call = {"call"};
  BoardExpectation expected;
  expected.optional.push_back({{"Spare", "0x3"}, {{"Toy", loops}}});
  Board old;
  old.name = "toy";
  old.build = "a build";
  old.graphs = {{"Chain", "0x1"}};
  old.provenance.machine = "a bench";
  old.provenance.inputs = 20;
  old.provenance.margin_percent = 5;
  old.kernels.push_back({{"Other", call}, {7}});
  compute_costs(old);
  Measurement measurement;
  measurement.build = "a build";
  measurement.machine = "a bench";
  measurement.kernels.push_back(costs_of(parsed(k_seen, {0, 1000}), nullptr, 0));
  BoardRequest request;
  request.inputs = 20;
  request.margin_percent = 5;

  const Board board = with_kernels(old, measurement, request, expected);
  ASSERT_EQ(board.graphs.size(), 2u);
  EXPECT_EQ(board.graphs[1].name, "Spare");
  ASSERT_EQ(board.costs.size(), 2u);
  EXPECT_EQ(board.costs[0].cost_ps[0], 7'000);
  EXPECT_EQ(bound_ns(board.costs[1], {{1, 10}}), 1000);

  Board stale = board;
  stale.kernels[1].cost = {1, 1};
  const Board again = with_kernels(stale, measurement, request, expected);
  EXPECT_EQ(again.graphs.size(), 2u);
  EXPECT_EQ(bound_ns(again.costs[1], {{1, 10}}), 1000);

  const auto refused = [&](const auto& change) {
    Measurement other = measurement;
    BoardRequest asked = request;
    change(other, asked);
    EXPECT_THROW((void)with_kernels(old, other, asked, expected), InputError);
  };
  refused([](Measurement& m, BoardRequest&) { m.build = "another build"; });
  refused([](Measurement& m, BoardRequest&) { m.machine = "another bench"; });
  refused([](Measurement& m, BoardRequest&) { m.count_instructions = false; });
  refused([](Measurement&, BoardRequest& r) { r.inputs = 40; });
  refused([](Measurement&, BoardRequest& r) { r.margin_percent = 10; });
}

}  // namespace
}  // namespace glint
