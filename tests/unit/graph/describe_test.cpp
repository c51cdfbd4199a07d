#include <gtest/gtest.h>

#include "small_graph.hpp"

namespace glint::test::describe_test {
namespace {

using Words = Description<SmallGraph>;

TEST(Describe, ListsEachCopyOfEachNodeWithItsLevel) {
  ASSERT_EQ(Words::nodes.size(), 4u);
  EXPECT_EQ(Words::nodes[0].name, "ScaleRow");
  EXPECT_EQ(Words::nodes[1].name, "SumBand");
  EXPECT_EQ(Words::nodes[2].name, "SumBand");
  EXPECT_EQ(Words::nodes[2].copy, 1);
  EXPECT_EQ(Words::nodes[2].copies, 2);
  EXPECT_EQ(Words::nodes[3].name, "AddUp");
  EXPECT_EQ(Words::nodes[0].level, 0);
  EXPECT_EQ(Words::nodes[2].level, 1);
  EXPECT_EQ(Words::nodes[3].level, 2);
}

TEST(Describe, ListsWhatFlowsWithInputsAndFeedbackMarked) {
  struct Row4 {
    int from, to;
    std::string_view token;
    EdgeKind kind;
  };
  const Row4 expected[] = {{-1, 0, "Row", EdgeKind::token},     {-1, 0, "Scale", EdgeKind::latest},
                           {0, 1, "Scaled", EdgeKind::token},   {1, 3, "Sum", EdgeKind::parts},
                           {3, 3, "Total", EdgeKind::previous}, {3, -1, "Total", EdgeKind::token}};
  ASSERT_EQ(Words::edges.size(), std::size(expected));
  for (std::size_t i = 0; i < std::size(expected); ++i) {
    EXPECT_EQ(Words::edges[i].from, expected[i].from) << i;
    EXPECT_EQ(Words::edges[i].to, expected[i].to) << i;
    EXPECT_EQ(Words::edges[i].token, expected[i].token) << i;
    EXPECT_EQ(Words::edges[i].kind, expected[i].kind) << i;
  }
}

// A literal: g++ and clang++ must compute the same signature.
TEST(Describe, HasOneSignatureOnEveryCompiler) { EXPECT_EQ(Words::signature, 0x2832764870b6c935u); }

struct SumBandToo {
  void operator()(const Scaled&, Partition, Sum&) const noexcept {}
};
struct AddUpThree {
  void operator()(const Parts<Sum, 3>&, const Previous<Total>&, Total&) const noexcept {}
};

TEST(Describe, ChangesTheSignatureWithTheWiring) {
  using OtherListing =
      Graph<Inputs<Row, Latest<Scale>>, Outputs<Total>, ScaleRow, AddUp, Split<SumBand, 2>>;
  using OtherNode =
      Graph<Inputs<Row, Latest<Scale>>, Outputs<Total>, AddUp, Split<SumBandToo, 2>, ScaleRow>;
  using OtherCount =
      Graph<Inputs<Row, Latest<Scale>>, Outputs<Total>, AddUpThree, Split<SumBand, 3>, ScaleRow>;
  using OtherOutput =
      Graph<Inputs<Row, Latest<Scale>>, Outputs<Scaled>, AddUp, Split<SumBand, 2>, ScaleRow>;
  EXPECT_EQ(Description<OtherListing>::signature, Words::signature)
      << "the same order of execution is the same graph";
  EXPECT_NE(Description<OtherNode>::signature, Words::signature);
  EXPECT_NE(Description<OtherCount>::signature, Words::signature);
  EXPECT_NE(Description<OtherOutput>::signature, Words::signature);
}

// A split token's writer is the first copy. A token without a writer is an input (from -1).
struct Twice {
  void operator()(const Previous<Parts<Sum, 2>>&, const Latest<Scale>&, Partition,
                  Sum&) const noexcept {}
};

TEST(Describe, MarksFeedbackOfPartsAndOutputsOfPartsByTheirFirstCopy) {
  using Fed = Graph<Inputs<Latest<Scale>>, Outputs<Parts<Sum, 2>>, Split<Twice, 2>>;
  constexpr auto& edges = Description<Fed>::edges;
  ASSERT_EQ(edges.size(), 3U);
  EXPECT_EQ(edges[0].kind, EdgeKind::previous);
  EXPECT_EQ(edges[0].from, 0);
  EXPECT_EQ(edges[0].to, 0);
  EXPECT_EQ(edges[0].token, "Sum");
  EXPECT_EQ(edges[1].kind, EdgeKind::latest);
  EXPECT_EQ(edges[1].from, -1);
  EXPECT_EQ(edges[2].kind, EdgeKind::parts);
  EXPECT_EQ(edges[2].from, 0);
  EXPECT_EQ(edges[2].to, -1);
}

// Two chains of different length: a node's level is its longest path, not its index in the list.
template <class In, class Out>
struct Pass {
  void operator()(const In&, Out&) const noexcept {}
};
struct Meet {
  void operator()(const Total&, const Scale&, Sum&) const noexcept {}
};

TEST(Describe, GivesEachNodeTheLongestPathToItAsItsLevel) {
  using Deep = Graph<Inputs<Row>, Outputs<Sum>, Meet, Pass<Row, Scale>, Pass<Scaled, Total>,
                     Pass<Row, Scaled>>;
  static_assert(Deep::level_count == 3);
  constexpr auto& nodes = Description<Deep>::nodes;
  // Execution order: of all ready nodes the first in the list runs next.
  EXPECT_EQ(nodes[0].level, 0);
  EXPECT_EQ(nodes[1].level, 0);
  EXPECT_EQ(nodes[2].level, 1);
  EXPECT_EQ(nodes[3].level, 2);
  EXPECT_EQ(nodes[3].name, "Meet");
  static_assert(!Deep::has_split && SmallGraph::has_split);
}

}  // namespace
}  // namespace glint::test::describe_test
