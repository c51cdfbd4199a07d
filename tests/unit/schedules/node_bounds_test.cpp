#include "schedules/node_bounds.hpp"

#include <gtest/gtest.h>

#include "tests/unit/platform/budget/toy_graph.hpp"

namespace glint {
namespace {

constexpr std::array<KernelCost, 2> k_costs = {{
    {"FitSpots", {"call", "tools", "blobs"}, {1'000, 10'000, 2}},
    {"FindSpots", {"call", "pixels"}, {500, 10}},
}};
constexpr CostTable k_table = {"toy", "any", "none", k_costs};

TEST(NodeBounds, AreDeclaredMaximaTimesCostsInTheOrderOfExecution) {
  constexpr Limits limits{.width = 100, .height = 10, .tools = 3, .blobs = 4};
  constexpr auto bounds = node_bounds<toy::Chain>(k_table, limits);
  static_assert(bounds.size() == 2);
  EXPECT_EQ(bounds[0], 11);  // 500 + 1000 x 10 ps, rounded up
  EXPECT_EQ(bounds[1], 32);  // 1000 + 3 x 10000 + 4 x 2 ps, rounded up
}

TEST(NodeBounds, GiveEachCopyOfASplitTheSameBound) {
  using Split =
      graph::Graph<graph::Inputs<toy::Picture>, graph::Outputs<graph::Parts<toy::Spots, 3>>,
                   graph::Split<toy::FindSpots, 3>>;
  constexpr auto bounds = node_bounds<Split>(k_table, Limits{.width = 10, .height = 10});
  EXPECT_EQ(bounds, (std::array<std::int64_t, 3>{2, 2, 2}));
}

// Copy i processes every third tool, starting with tool i.
struct UnequalPartitions {
  static constexpr std::array<std::string_view, 2> k_loops = {"call", "tools"};
  [[nodiscard]] static constexpr graph::LoopCounts worst(const Limits& limits) noexcept {
    return worst(limits, {0, 3});
  }
  [[nodiscard]] static constexpr graph::LoopCounts worst(const Limits& limits,
                                                         graph::Partition partition) noexcept {
    return {{1, (limits.tools - partition.index + partition.count - 1) / partition.count}};
  }
  [[nodiscard]] graph::LoopCounts counts() const noexcept { return {}; }
  void operator()(const toy::Picture& /*picture*/, graph::Partition /*partition*/,
                  toy::Spots& /*spots*/) noexcept {}
};

TEST(NodeBounds, GiveEachCopyItsOwnWhereTheNodeTellsThemApart) {
  using Split =
      graph::Graph<graph::Inputs<toy::Picture>, graph::Outputs<graph::Parts<toy::Spots, 3>>,
                   graph::Split<UnequalPartitions, 3>>;
  const std::array<KernelCost, 1> costs = {{{"UnequalPartitions", {"call", "tools"}, {0, 1'000}}}};
  const auto bounds = node_bounds<Split>({"toy", "any", "none", costs}, Limits{.tools = 5});
  EXPECT_EQ(bounds, (std::array<std::int64_t, 3>{2, 2, 1}));
}

TEST(NodeBounds, NameTheNodeThatATableDoesNotPrice) {
  EXPECT_EQ(missing_cost<toy::Chain>(k_table), "");
  const CostTable half{"half", "any", "none", std::span(k_costs).subspan(0, 1)};
  EXPECT_EQ(missing_cost<toy::Chain>(half), "FindSpots");
  EXPECT_EQ(node_bounds<toy::Chain>(half, Limits{})[0], k_no_bound);
}

TEST(NodeBounds, DoNotTakeCostsOfOtherLoopsForTheirOwn) {
  std::array<KernelCost, 2> stale = k_costs;
  stale[0].loops[1] = "markers";
  EXPECT_EQ(missing_cost<toy::Chain>({"stale", "any", "none", stale}), "FitSpots");
  stale = k_costs;
  stale[1].loops[2] = "gone";
  stale[1].cost_ps[2] = 5;
  EXPECT_EQ(missing_cost<toy::Chain>({"stale", "any", "none", stale}), "FindSpots");
}

}  // namespace
}  // namespace glint
