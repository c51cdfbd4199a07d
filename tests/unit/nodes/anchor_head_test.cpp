#include "nodes/anchor_head.hpp"

#include <gtest/gtest.h>

#include <memory>

namespace glint {
namespace {

// One reference body in front of a static head.
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
    verdict.reason = refused_ ? Reason::frame_late : Reason::none;
    last_ = out_;
    node_(verdict, head, tools, *fitted_, graph::Previous<Anchor>(last_), out_);
  }

  bool refused_ = false;
  ToolSet set_;
  std::unique_ptr<graph::Parts<FittedTools, k_tool_partitions>> fitted_ =
      std::make_unique<graph::Parts<FittedTools, k_tool_partitions>>();
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
  body().odds = k_odds_min - 1;
  for (int i = 1; i < 9; ++i) frame(i);
  EXPECT_EQ(node_.counts(), (graph::LoopCounts{{1}}));
  EXPECT_FALSE(out_.state.known());
}

// Tool frame offset from the markers' mean, and a rotated head.
TEST_F(AnchorHeadByABody, PlacesTheReferencesOwnFrameInTheWorld) {
  set_.items[0].markers_m = {Vector3(0.1, 0, 0), Vector3(0, 0.2, 0), Vector3(0, 0, 0.3)};
  body().T_camera_tool = {Quaternion(0.8, 0, 0.6, 0), Vector3(0.1, -0.2, 0.5)};
  frame(1);
  EXPECT_EQ(out_.body, 5U);
  EXPECT_EQ(out_.now.head.time, Time{} + milliseconds(22));
  EXPECT_LT((out_.T_world_reference.translation - Vector3(0.1, -0.2, 0.5)).norm(), 1e-9);
  EXPECT_LT((out_.T_world_reference.rotation.coeffs() - Quaternion(0.8, 0, 0.6, 0).coeffs()).norm(),
            1e-9);
}

TEST_F(AnchorHeadByABody, HasNoBodyWhereTheSetHasNoSuchTool) {
  frame(1);
  ASSERT_TRUE(out_.state.known());
  for (const int reference : {-1, 1, 16}) {
    node_.reference = reference;
    frame(2);
    EXPECT_EQ(out_.body, 0U) << reference;
    EXPECT_FALSE(out_.state.known());
    EXPECT_EQ(node_.counts(), (graph::LoopCounts{{1}}));
  }
  node_.reference = 0;
  node_.limits.tools = 0;
  frame(3);
  EXPECT_EQ(out_.body, 0U) << "beyond the cell's tools";
}

TEST_F(AnchorHeadByABody, FindsTheBodyInItsSlice) {
  set_.count = 6;
  set_.items[5] = set_.items[0];
  set_.items[5].identity = 9;
  (*fitted_)[1].tools[5] = body();
  body().reason = Reason::no_labeling;
  node_.reference = 5;
  frame(1);
  EXPECT_TRUE(out_.state.known());
  EXPECT_EQ(out_.body, 9U);
  EXPECT_EQ(node_.counts(), (graph::LoopCounts{{1, 1}}));
}

TEST_F(AnchorHeadByABody, KeepsWhatItKnowsInARefusedFrame) {
  for (int i = 1; i < 9; ++i) frame(i);
  const Anchor before = out_;
  refused_ = true;
  frame(9);
  EXPECT_TRUE(out_.state.known());
  EXPECT_EQ(out_.body, before.body);
  EXPECT_EQ(out_.T_world_reference.translation, before.T_world_reference.translation);
  EXPECT_FALSE(out_.now.head.valid) << "of this frame nothing is";
  EXPECT_EQ(node_.counts(), (graph::LoopCounts{{1}}));
}

// A clock restart leaves the head's motion unknown: the node drops its correction.
TEST_F(AnchorHeadByABody, LosesItsCorrectionWhereTheClockRestarts) {
  for (int i = 1; i < 30; ++i) frame(i);
  body().reason = Reason::no_labeling;
  const Anchor seen = out_;
  frame(30);
  const Matrix6 next = out_.now.shared;
  out_ = seen;
  frame(1, true);
  EXPECT_TRUE(out_.state.known());
  EXPECT_GT(out_.now.shared.trace(), 10 * next.trace());
  const Matrix6 uncorrected = out_.state.uncorrected_covariance_at(out_.now.pivot_m);
  EXPECT_NEAR(out_.now.shared.trace(), uncorrected.trace(), 1e-9 * uncorrected.trace());
}

}  // namespace
}  // namespace glint
