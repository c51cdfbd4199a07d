#include "nodes/anchor_head.hpp"

#include <gtest/gtest.h>

#include <memory>

namespace glint {
namespace {

// One body before a resting head.
class AnchorHeadByABody : public testing::Test {
 protected:
  AnchorHeadByABody() {
    set_.count = 1;
    set_.items[0].marker_count = 3;
    set_.items[0].identity = 5;
    body().reason = Reason::none;
    body().T_camera_tool.translation = {0, 0, 0.5};
    body().covariance = Matrix6::Identity() * 1e-7;
    node_.reference = 0;
  }
  FittedTool& body() { return (*fitted_)[0].tools[0]; }
  void frame(int number, bool restarted = false) {
    graph::Latest<ToolSet> tools;
    tools.set(set_, 1, 0);
    HeadPose head;
    head.valid = true;
    head.time = Time{} + milliseconds(22) * number;
    FrameVerdict verdict;
    verdict.stamp.mid_exposure = head.time;
    verdict.resynchronised = restarted;
    last_ = out_;
    node_(verdict, head, tools, *fitted_, graph::Previous<Anchor>(last_), out_);
  }

  ToolSet set_;
  std::unique_ptr<graph::Parts<FittedTools, k_tool_slices>> fitted_ =
      std::make_unique<graph::Parts<FittedTools, k_tool_slices>>();
  Anchor last_, out_;
  glint::AnchorHead node_;
};

TEST_F(AnchorHeadByABody, ForgetsTheBodyWhereAnotherTookItsPlace) {
  for (int i = 1; i < 9; ++i) frame(i);
  ASSERT_TRUE(out_.state.known());
  body().reason = Reason::no_labeling;
  frame(9);
  ASSERT_TRUE(out_.state.known()) << "hidden it is where it was";
  set_.items[0].identity = 6;
  frame(10);
  EXPECT_FALSE(out_.state.known());
}

TEST_F(AnchorHeadByABody, CountsTheFramesThatShowTheBody) {
  frame(1);
  EXPECT_EQ(node_.counts(), (graph::LoopCounts{{1, 1}}));
  body().reason = Reason::no_labeling;
  frame(2);
  EXPECT_EQ(node_.counts(), (graph::LoopCounts{{1}}));
}

TEST_F(AnchorHeadByABody, TakesNoAmbiguousPoseForTheBodys) {
  body().odds = k_odds_least - 1;
  for (int i = 1; i < 9; ++i) frame(i);
  EXPECT_EQ(node_.counts(), (graph::LoopCounts{{1}}));
  EXPECT_FALSE(out_.state.known());
}

// How long the head moved unseen is unknown then: its correction counts for nothing any more.
TEST_F(AnchorHeadByABody, LosesItsCorrectionWhereTheClockRestarts) {
  for (int i = 1; i < 30; ++i) frame(i);
  body().reason = Reason::no_labeling;
  const Anchor seen = out_;
  frame(30);
  const Matrix6 next = out_.now.lasting;
  out_ = seen;
  frame(1, true);
  EXPECT_TRUE(out_.state.known());
  EXPECT_GT(out_.now.lasting.trace(), 10 * next.trace());
  const Matrix6 uncorrected = out_.state.uncorrected_at(out_.now.pivot_m);
  EXPECT_NEAR(out_.now.lasting.trace(), uncorrected.trace(), 1e-9 * uncorrected.trace());
}

}  // namespace
}  // namespace glint
