// Topological order of nodes from the tokens that they read: levels, ties and cycles.
#include "graph/wiring.hpp"

#include <gtest/gtest.h>

namespace glint::graph::wiring_test {
namespace {

constexpr PortKind k_read = PortKind::read;

// Node i writes token i. Nodes 2 and 3 form a cycle; node 0 reads 3 and is blocked too.
constexpr std::array<int, 4> k_writer = {0, 1, 2, 3};
constexpr std::array<PortRow, 4> k_cycle = {
    {{0, k_read, 3}, {1, PortKind::previous, 3}, {2, k_read, 3}, {3, k_read, 2}}};

TEST(SortUnits, NameANodeOnTheCycleAndWhatItWaitsFor) {
  constexpr auto order = sort_units<4>(k_cycle, k_writer);
  EXPECT_EQ(order.placed, 1) << "feedback waits for nothing";
  EXPECT_EQ(order.units, (std::array<int, 4>{1, 0, 2, 3})) << "each node once all the same";
  EXPECT_TRUE(order.cycle_unit == 2 || order.cycle_unit == 3) << "node 0 is only behind it";
  EXPECT_EQ(order.cycle_token, order.cycle_unit == 2 ? 3 : 2);
}

// Node 3 reads inputs only, node 1 reads 3, node 0 reads both, node 2 reads 3.
constexpr std::array<PortRow, 6> k_tree = {{{0, k_read, 1},
                                            {0, k_read, 3},
                                            {1, k_read, 3},
                                            {2, k_read, 3},
                                            {3, k_read, 4},
                                            {3, k_read, 5}}};
constexpr std::array<int, 6> k_tree_writer = {0, 1, 2, 3, -1, -1};

TEST(SortUnits, PlaceEachNodeBehindWhatItReadsAndTiesAsListed) {
  constexpr auto order = sort_units<4>(k_tree, k_tree_writer);
  EXPECT_EQ(order.placed, 4);
  EXPECT_EQ(order.units, (std::array<int, 4>{3, 1, 0, 2}));
  EXPECT_EQ(order.level, (std::array<int, 4>{2, 1, 1, 0}));
  EXPECT_EQ(order.levels, 3);
  EXPECT_EQ(order.cycle_unit, -1);
  EXPECT_EQ(order.cycle_token, -1);
}

}  // namespace
}  // namespace glint::graph::wiring_test
