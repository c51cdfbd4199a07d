// Schedule tables of an executor: accepted nodes, rejected faults, and which node reads which.
#include "graph/plan_tables.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <initializer_list>

#include "small_graph.hpp"
#include "wide_graph.hpp"

namespace glint::test::plan_tables_test {
namespace {

using Tables = ScheduleTables<WideGraph>;

constexpr NodeSet set_of(std::initializer_list<int> nodes) {
  NodeSet set = 0;
  for (const int node : nodes) set |= NodeSet{1} << node;
  return set;
}

// Node 0 is Make, 1 to 5 Spread, 6 to 8 SumUp, 9 Merge. Feedback is the last activation's.
TEST(Needs, AreAllCopiesOfEachWriterOfThisActivation) {
  EXPECT_EQ(
      predecessors<WideGraph>[0], NodeSet { 0 });
  for (std::size_t spread = 1; spread <= 5; ++spread) {
    EXPECT_EQ(predecessors<WideGraph>[spread], set_of({0}));
  }
  for (std::size_t sum = 6; sum <= 8; ++sum) {
    EXPECT_EQ(predecessors<WideGraph>[sum], set_of({1, 2, 3, 4, 5}));
  }
  EXPECT_EQ(predecessors<WideGraph>[9], set_of({0, 6, 7, 8}));
  // ScaleRow reads inputs only, AddUp its own last total.
  EXPECT_EQ(predecessors<SmallGraph>, (std::array<NodeSet, 4>{0, 1, 1, set_of({1, 2})}));
}

TEST(PlanTables, TakeNodesInOrderForWorkersThatThereAre) {
  Tables tables;
  tables.workers = 2;
  EXPECT_TRUE(tables.add(0, 0));
  EXPECT_TRUE(tables.add(9, 1));
  EXPECT_TRUE(tables.add(4, 1));
  EXPECT_FALSE(tables.add(-1, 0));
  EXPECT_FALSE(tables.add(10, 0));
  EXPECT_FALSE(tables.add(1, -1));
  EXPECT_FALSE(tables.add(1, 2));
  EXPECT_EQ(tables.count[0], 1);
  EXPECT_EQ(tables.count[1], 2);
  EXPECT_EQ(tables.order[1][0], 9);
  EXPECT_EQ(tables.order[1][1], 4);
  EXPECT_EQ(tables.worker[0], 0);
  EXPECT_EQ(tables.worker[4], 1);
  EXPECT_EQ(tables.worker[9], 1);
  EXPECT_EQ(tables.nodes_of(0), set_of({0}));
  EXPECT_EQ(tables.nodes_of(1), set_of({4, 9}));
  EXPECT_EQ(tables.nodes_of(2), NodeSet{0});
}

TEST(PlanTables, TakeNoMoreThanTheGraphsNodesForAWorker) {
  Tables tables;
  for (int i = 0; i < WideGraph::node_count; ++i) EXPECT_TRUE(tables.add(i, 0));
  EXPECT_FALSE(tables.add(3, 0));
  EXPECT_EQ(tables.count[0], 10);
  EXPECT_FALSE(schedule_fault(tables).found());
}

struct Case {
  const char* name;
  void (*spoil)(Tables&);
  PlanError error;
  int node;
};

TEST(PlanFault, NamesTheFirstNodeThatDoesNotFit) {
  const Case cases[] = {
      {"fits", [](Tables&) {}, PlanError::none, -1},
      {"no workers", [](Tables& t) { t.workers = 0; }, PlanError::workers, -1},
      {"too many workers", [](Tables& t) { t.workers = 5; }, PlanError::workers, -1},
      {"most workers", [](Tables& t) { t.workers = 4; }, PlanError::none, -1},
      {"beyond the last", [](Tables& t) { t.order[1][0] = 10; }, PlanError::unknown_node, 10},
      {"twice, by two workers", [](Tables& t) { t.order[1][0] = 3; }, PlanError::ran_twice, 3},
      {"one left out",
       [](Tables& t) {
         t.order[1][1] = t.order[1][2];
         --t.count[1];
       },
       PlanError::left_out, 4},
      {"the last left out", [](Tables& t) { --t.count[0]; }, PlanError::left_out, 9},
      {"a worker not counted", [](Tables& t) { t.workers = 1; }, PlanError::left_out, 2},
      {"the first on another worker", [](Tables& t) { std::swap(t.order[0][0], t.order[1][0]); },
       PlanError::first_node, 0},
      {"the first behind another", [](Tables& t) { std::swap(t.order[0][0], t.order[0][1]); },
       PlanError::first_node, 0},
      {"before what it reads",
       [](Tables& t) {
         std::swap(t.order[0][3], t.order[0][4]);  // SumUp before a Spread that it reads
       },
       PlanError::waits, 6},
  };
  for (const Case& c : cases) {
    Tables tables = default_schedule<WideGraph>(2);
    c.spoil(tables);
    const PlanFault fault = schedule_fault(tables);
    EXPECT_EQ(fault.error, c.error) << c.name;
    EXPECT_EQ(fault.node, c.node) << c.name;
    EXPECT_EQ(fault.found(), c.error != PlanError::none) << c.name;
  }
}

TEST(PlanFault, FindsNoFirstNodeWhereWorkerZeroHasNone) {
  Tables tables;
  tables.workers = 2;
  for (int node = 0; node < WideGraph::node_count; ++node) tables.add(node, 1);
  EXPECT_EQ(schedule_fault(tables).error, PlanError::first_node);
}

// Deadlock: each worker's next node needs a node that another worker runs later.
TEST(PlanFault, FindsWorkersThatWaitForEachOther) {
  Tables tables;
  tables.workers = 3;
  for (const int node : {0, 1, 2, 6, 3}) tables.add(node, 0);
  for (const int node : {7, 4, 5}) tables.add(node, 1);
  for (const int node : {8, 9}) tables.add(node, 2);
  const PlanFault fault = schedule_fault(tables);
  EXPECT_EQ(fault.error, PlanError::waits);
  EXPECT_EQ(fault.node, 6) << "the first worker's next";
}

TEST(PlanByRule, IsForOneToFourWorkers) {
  for (const int requested : {-3, 0, 1, 2, 3, 4, 5, 99}) {
    const Tables tables = default_schedule<WideGraph>(requested);
    EXPECT_EQ(tables.workers, std::clamp(requested, 1, 4));
    EXPECT_FALSE(schedule_fault(tables).found()) << requested;
    for (int copy = 0; copy < 5; ++copy) {
      EXPECT_EQ(tables.worker[static_cast<std::size_t>(1 + copy)], copy % tables.workers);
    }
    EXPECT_EQ(tables.worker[0], 0);
    EXPECT_EQ(tables.worker[9], 0);
  }
}

}  // namespace
}  // namespace glint::test::plan_tables_test
