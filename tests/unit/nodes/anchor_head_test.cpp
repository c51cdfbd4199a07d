#include "nodes/anchor_head.hpp"

#include <gtest/gtest.h>

#include <memory>

namespace glint {
namespace {

TEST(AnchorHead, ForgetsTheBodyWhereAnotherTookItsPlace) {
  ToolSet set;
  set.count = 1;
  set.items[0].marker_count = 3;
  set.items[0].identity = 5;
  const auto fitted = std::make_unique<graph::Parts<FittedTools, k_tool_slices>>();
  FittedTool& body = (*fitted)[0].tools[0];
  body.reason = Reason::none;
  body.T_camera_tool.translation = {0, 0, 0.5};
  body.covariance = Matrix6::Identity() * 1e-7;
  glint::AnchorHead node;
  node.reference = 0;
  Anchor last, out;
  const auto frame = [&](int number) {
    graph::Latest<ToolSet> tools;
    tools.set(set, 1, 0);
    HeadPose head;
    head.valid = true;
    head.time = Time{} + milliseconds(22) * number;
    FrameVerdict verdict;
    verdict.stamp.mid_exposure = head.time;
    last = out;
    node(verdict, head, tools, *fitted, graph::Previous<Anchor>(last), out);
  };
  for (int i = 1; i < 9; ++i) frame(i);
  ASSERT_TRUE(out.state.known());
  body.reason = Reason::no_labeling;
  frame(9);
  ASSERT_TRUE(out.state.known()) << "hidden it is where it was";
  set.items[0].identity = 6;
  frame(10);
  EXPECT_FALSE(out.state.known());
}

}  // namespace
}  // namespace glint
