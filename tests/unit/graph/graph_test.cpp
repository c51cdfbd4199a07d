#include <gtest/gtest.h>

#include <vector>

#include "graph/loops.hpp"
#include "small_graph.hpp"

namespace glint::test {
int total_with_core_flags();  // core_flags.cpp
}  // namespace glint::test

namespace glint::test::graph_test {

namespace {

TEST(Graph, RunsNodesInTheOrderOfTheirDataNotOfTheirListing) {
  static SmallGraph graph;
  graph.latest<Scale>().set({10}, 1, 0);
  graph.input<Row>().numbers = {1, 2, 3, 4, 5, 6, 7, 8};
  graph.activate();
  EXPECT_EQ(graph.output<Total>().value, 360);
}

TEST(Graph, GivesTheFirstActivationAnEmptyPreviousAndEachLaterOneTheLastToken) {
  static SmallGraph graph;
  graph.latest<Scale>().set({1}, 1, 0);
  graph.input<Row>().numbers = {1, 1, 1, 1, 1, 1, 1, 1};
  for (int activation = 1; activation <= 5; ++activation) {
    graph.activate();
    EXPECT_EQ(graph.output<Total>().activations, activation);
    EXPECT_EQ(graph.output<Total>().value, 8 * activation);
  }
}

TEST(Graph, WritesThePartsOfASplitInIndexOrderWithAStateForEachCopy) {
  static SmallGraph graph;
  graph.latest<Scale>().set({1}, 1, 0);
  graph.input<Row>().numbers = {1, 1, 1, 1, 2, 2, 2, 2};
  graph.activate();
  EXPECT_EQ(graph.parts<Sum>(0).value, 4);
  EXPECT_EQ(graph.parts<Sum>(1).value, 8);
  EXPECT_EQ(graph.node<SumBand>(0).calls, 1);
  EXPECT_EQ(graph.node<SumBand>(1).calls, 1);
  int copies = 0;
  graph.for_each<SumBand>([&](SumBand&) { ++copies; });
  EXPECT_EQ(copies, 2);
}

TEST(Graph, UsesTheSettingsOfItsNodes) {
  static SmallGraph graph;
  graph.node<ScaleRow>().offset = 3;
  graph.activate();
  EXPECT_EQ(graph.output<Total>().value, 24);
  EXPECT_EQ(graph.token<Scaled>().numbers[5], 3);
}

TEST(Graph, PreparesAllNodesAndNamesTheFirstThatFails) {
  static SmallGraph graph;
  EXPECT_TRUE(graph.prepare());
  graph.node<ScaleRow>().offset = -1;
  const Prepared prepared = graph.prepare();
  EXPECT_FALSE(prepared);
  EXPECT_EQ(prepared.node, 0);
  EXPECT_EQ(prepared.name, "ScaleRow");
  EXPECT_EQ(prepared.reason, static_cast<int>(Ready::no_offset));
}

// Two nodes whose prepare() fails, listed in the reverse of their execution order.
template <class In, class Out, int reason>
struct Unready {
  Ready prepare() const { return static_cast<Ready>(reason); }
  void operator()(const In&, Out&) const noexcept {}
};

TEST(Graph, StopsPreparingAtTheFirstFailure) {
  using FailsFirst = Unready<Row, Scaled, 3>;
  using FailsNext = Unready<Scaled, Total, 4>;
  static Graph<Inputs<Row>, Outputs<Total>, FailsNext, FailsFirst> graph;
  const Prepared prepared = graph.prepare();
  EXPECT_EQ(prepared.node, 0);
  EXPECT_EQ(prepared.reason, 3);
}

struct UnreadyBand {
  bool is_ready = true;
  Ready prepare() const { return is_ready ? Ready::yes : Ready::no_offset; }
  void operator()(const Row&, Partition, Sum&) const noexcept {}
};

TEST(Graph, NamesTheCopyOfASplitThatFails) {
  static Graph<Inputs<Row>, Outputs<Parts<Sum, 3>>, Split<UnreadyBand, 3>> graph;
  EXPECT_TRUE(graph.prepare());
  graph.node<UnreadyBand>(2).is_ready = false;
  EXPECT_EQ(graph.prepare().node, 2);
  graph.node<UnreadyBand>(1).is_ready = false;
  EXPECT_EQ(graph.prepare().node, 1);
}

struct Seen {
  std::vector<int>* numbers;
  void on_node_begin(int node) { numbers->push_back(node); }
  void on_node_end(int node) { numbers->push_back(-node); }
};

TEST(Graph, ShowsATraceEveryCopyOfEveryNodeInOrder) {
  static SmallGraph graph;
  std::vector<int> numbers;
  Seen trace{&numbers};
  graph.activate(trace);
  EXPECT_EQ(numbers, (std::vector<int>{0, 0, 1, -1, 2, -2, 3, -3}));
}

// Boundary that ends the activation after `node` and records each call.
struct EndAfter {
  int node;
  std::vector<int> go_on_calls;
  bool go_on(int at) {
    go_on_calls.push_back(at);
    return at < node;
  }
};

TEST(Graph, EndsAnActivationAtTheNodeThatItsBoundaryNames) {
  for (int last = 0; last < SmallGraph::node_count; ++last) {
    static SmallGraph graph;
    graph.latest<Scale>().set({1}, 1, 0);
    graph.input<Row>().numbers = {1, 1, 1, 1, 1, 1, 1, 1};
    graph.activate();
    const Total before = graph.output<Total>();
    std::vector<int> numbers;
    Seen trace{&numbers};
    EndAfter boundary{last, {}};
    EXPECT_EQ(graph.activate_until(trace, boundary), last);
    std::vector<int> begun, go_on_calls;
    for (int node = 0; node <= last; ++node) {
      begun.insert(begun.end(), {node, -node});
      go_on_calls.push_back(node);
    }
    EXPECT_EQ(numbers, begun);
    EXPECT_EQ(boundary.go_on_calls, go_on_calls);
    // An activation that ends early does not advance the feedback.
    const bool whole = last == SmallGraph::node_count - 1;
    EXPECT_EQ(graph.output<Total>().activations, before.activations + (whole ? 1 : 0));
    graph.activate();
    EXPECT_EQ(graph.output<Total>().activations, before.activations + (whole ? 2 : 1));
    EXPECT_EQ(graph.output<Total>().value, 8 * graph.output<Total>().activations);
  }
}

TEST(Loops, AreWithinTheirWorstUpToEachOfThem) {
  LoopCounts worst;
  for (std::size_t loop = 0; loop < k_loops_max; ++loop) worst[loop] = 10;
  EXPECT_TRUE(within(worst, worst));
  EXPECT_TRUE(within({}, worst));
  for (std::size_t loop = 0; loop < k_loops_max; ++loop) {
    LoopCounts counts = worst;
    ++counts[loop];
    EXPECT_FALSE(within(counts, worst)) << loop;
    EXPECT_NE(counts, worst);
  }
}

struct Big {
  std::array<char, 1 << 20> bytes{};
};
struct Small {
  int value = 0;
};
struct Fill {
  void operator()(const Small& small, Big& big) const noexcept {
    big.bytes[0] = static_cast<char>(small.value);
  }
};

TEST(Graph, HoldsEachTokenOnceAndNothingOutsideItself) {
  using OneToken = Graph<Inputs<Small>, Outputs<Big>, Fill>;
  EXPECT_GE(sizeof(OneToken), sizeof(Big));
  EXPECT_LT(sizeof(OneToken), sizeof(Big) + 512);
}

struct First {
  int value = 0;
};
struct Second {
  int value = 0;
};
struct MakeFirst {
  void operator()(const Small& in, First& out) const noexcept { out.value = in.value; }
};
struct MakeSecond {
  void operator()(const Small& in, Second& out) const noexcept { out.value = in.value; }
};

TEST(Graph, BreaksTiesInTheOrderListed) {
  using OneWay = Graph<Inputs<Small>, Outputs<First, Second>, MakeSecond, MakeFirst>;
  using OtherWay = Graph<Inputs<Small>, Outputs<First, Second>, MakeFirst, MakeSecond>;
  EXPECT_EQ(Description<OneWay>::nodes[0].name, "MakeSecond");
  EXPECT_EQ(Description<OtherWay>::nodes[0].name, "MakeFirst");
}

// Reads its own last token while it writes the next one: this requires two buffers.
struct Fibonacci {
  int last = 0;
  int value = 0;
};
struct Step {
  void operator()(const Previous<Fibonacci>& before, Fibonacci& now) const noexcept {
    now.last = before.value().value;
    now.value = before.value().value + before.value().last;
    if (now.value == 0) now.value = 1;
  }
};

TEST(Graph, KeepsThePreviousTokenWholeWhileTheNextIsWritten) {
  static Graph<Inputs<>, Outputs<Fibonacci>, Step> graph;
  for (int i = 0; i < 10; ++i) graph.activate();
  EXPECT_EQ(graph.output<Fibonacci>().value, 55);
}

// Feedback of parts: each copy reads the part that it wrote itself.
struct Track {
  int value = 0;
};
struct Advance {
  void operator()(const Previous<Parts<Track, 3>>& last, Partition partition,
                  Track& track) const noexcept {
    track.value = last.value()[partition.index].value + partition.index + 1;
  }
};

TEST(Graph, FeedsPartsBackToTheirCopies) {
  static Graph<Inputs<>, Outputs<Parts<Track, 3>>, Split<Advance, 3>> graph;
  for (int i = 0; i < 4; ++i) graph.activate();
  for (int i = 0; i < 3; ++i) EXPECT_EQ(graph.parts<Track>(i).value, 4 * (i + 1));
}

TEST(Graph, BuildsAndRunsWithoutExceptionsAndTypeInformation) {
  EXPECT_EQ(total_with_core_flags(), 144);
}

}  // namespace
}  // namespace glint::test::graph_test
