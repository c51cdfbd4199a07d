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

// The number itself: g++ and clang++ both run this test.
TEST(Describe, HasOneSignatureOnEveryCompiler) { EXPECT_EQ(Words::signature, 0x2832764870b6c935u); }

struct SumBandToo {
  void operator()(const Scaled&, Slice, Sum&) const noexcept {}
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

}  // namespace
}  // namespace glint::test::describe_test
