// Node FollowRobot with moving links: the slices of a depth image pose the model, then register it.
#include "nodes/follow_robot.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/unit/heap_count.hpp"
#include "tests/unit/kernels/registration/box_model.hpp"

namespace glint {
namespace {

using test::BoxArm;
using test::k_truth;
using test::SampledModel;

constexpr int k_all = 1 << 28;  // steps that finish a depth image in one slice
constexpr double k_slide_m = 0.3;

// Arm of boxes; every other point is on a slide. In the depth images the slide is at k_slide_m; in
// the poses that the node receives it is at 0.
class FollowRobotTest : public testing::Test {
 protected:
  FollowRobotTest() {
    std::vector<std::int32_t> face(depth_.size());
    std::vector<ProjectedCorner> corners(64);
    EXPECT_EQ(
        render_depth({model_.corners, model_.faces}, k_truth, camera_, {depth_, face, corners}),
        Reason::none);
    for (float& z : depth_) z = z == 0 ? 1.9f : z;
    for (std::size_t i = 0; i < sampled_.points.size(); ++i) {
      links_.push_back(static_cast<std::uint16_t>(i % 2));
      if (i % 2 == 1) sampled_.points[i].x() -= static_cast<float>(k_slide_m);
    }
    given_.count = shown_.count = 2;
    shown_.T_root_link[1].translation.x() = k_slide_m;
  }

  // Prepared node with `steps` a slice; `links` poses its model.
  [[nodiscard]] FollowRobot node(int steps, ShownDepth::Links links) const {
    FollowRobot node;
    node.model = {sampled_.cloud(), links_};
    node.links = links;
    node.T_world_robot = k_truth;
    node.T_world_robot.translation.x() += 0.003;
    node.covariance = Matrix6::Identity() * 1e-4;
    node.pixels_max = static_cast<int>(depth_.size());
    node.limits.tracking_steps = steps;
    EXPECT_EQ(node.prepare(), Reason::none);
    return node;
  }
  [[nodiscard]] ShownDepth depth_image(int number, ShownDepth::Links links) const {
    ShownDepth out;
    out.scene = {camera_, depth_};
    out.links = links;
    out.time = Time{} + milliseconds(100) * number;
    out.number = static_cast<std::uint64_t>(number);
    return out;
  }
  // Runs all slices of a depth image, each within the declared maximum. Returns the steps.
  static int run(FollowRobot& node, const ShownDepth& shown, RobotProgress& progress) {
    int steps = 0;
    do {
      node(shown, progress);
      EXPECT_TRUE(graph::within(node.counts(), FollowRobot::worst(node.limits)));
      EXPECT_EQ(node.counts()[1], progress.steps);
      steps += progress.steps;
    } while (!progress.free);
    return steps;
  }
  [[nodiscard]] int posing_steps() const {
    return static_cast<int>(links_.size()) * k_posed_item_steps_max;  // a new link each time
  }

  const BoxArm model_;
  SampledModel sampled_{model_, 0.006f};
  std::vector<std::uint16_t> links_;
  const Pinhole camera_{160, 120, 150, 150, 80, 60};
  std::vector<float> depth_ = std::vector<float>(160 * 120);
  LinkPoses given_, shown_;
};

class FollowRobotInSlices : public FollowRobotTest, public testing::WithParamInterface<int> {};

// The result equals that of a node that was posed just before the image arrived.
TEST_P(FollowRobotInSlices, IsPosedBeforeItIsLookedFor) {
  FollowRobot posed = node(k_all, {&shown_, 1}), node = this->node(GetParam(), {&given_, 0});
  RobotProgress expected, progress;
  run(posed, depth_image(1, {&shown_, 1}), expected);
  ASSERT_EQ(expected.followed, 1);
  run(node, depth_image(1, {&shown_, 1}), progress);
  EXPECT_EQ(progress.followed, 1) << name_of(progress.last);
  EXPECT_EQ(progress.frame.T_world_robot.translation, expected.frame.T_world_robot.translation);
  EXPECT_EQ(progress.frame.T_world_robot.rotation.coeffs(),
            expected.frame.T_world_robot.rotation.coeffs());
  EXPECT_EQ(progress.frame.rms_m, expected.frame.rms_m);
}

INSTANTIATE_TEST_SUITE_P(OfAnySize, FollowRobotInSlices, testing::Values(1, 999, 50'000, k_all));

TEST_F(FollowRobotTest, HoldsThePictureAndSaysNothingOfItWhileItIsPosed) {
  constexpr int k_slice = 1'000;
  FollowRobot node = this->node(k_slice, {&given_, 0});
  const ShownDepth shown = depth_image(1, {&shown_, 1});
  RobotProgress progress;
  for (int posed = 0; posed + k_slice < posing_steps(); posed += progress.steps) {
    node(shown, progress);
    ASSERT_FALSE(progress.free);
    ASSERT_LT(progress.steps, k_slice + k_posed_item_steps_max);
  }
  EXPECT_EQ(progress.followed + progress.inconclusive + progress.jumps, 0);
  run(node, shown, progress);
  EXPECT_EQ(progress.followed, 1);
}

TEST_F(FollowRobotTest, IsLookedForByTheStepsThatPosingLeavesASlice) {
  FollowRobot node = this->node(posing_steps() + 1'000, {&given_, 0});
  RobotProgress progress;
  node(depth_image(1, {&shown_, 1}), progress);
  EXPECT_FALSE(progress.free);
  EXPECT_GE(progress.steps, posing_steps() + 1'000);
  EXPECT_TRUE(graph::within(node.counts(), FollowRobot::worst(node.limits)));
}

TEST_F(FollowRobotTest, IsPosedOnceByPosesOfOneNumber) {
  FollowRobot posed = node(k_all, {&shown_, 1}), node = this->node(k_all, {&given_, 0});
  RobotProgress progress;
  const auto more = [&](int number, ShownDepth::Links links) {
    return run(node, depth_image(number, links), progress) -
           run(posed, depth_image(number, {&shown_, 1}), progress);
  };
  EXPECT_EQ(more(1, {&shown_, 1}), posing_steps());
  EXPECT_EQ(more(2, {&shown_, 1}), 0);
  EXPECT_EQ(more(3, {nullptr, 1}), 0) << "it stands by them";
  EXPECT_EQ(more(4, {&shown_, 2}), posing_steps());
  EXPECT_EQ(progress.followed, 4);
}

TEST_F(FollowRobotTest, IsNotLookedForByPosesThatAreNotThereOrLackALink) {
  FollowRobot node = this->node(k_all, {&given_, 0});
  RobotProgress progress;
  EXPECT_EQ(run(node, depth_image(1, {nullptr, 1}), progress), 0);
  EXPECT_EQ(progress.inconclusive, 0);
  LinkPoses one = shown_;
  one.count = 1;
  EXPECT_LE(run(node, depth_image(2, {&one, 1}), progress), k_posed_item_steps_max);
  EXPECT_EQ(progress.inconclusive, 1);
  // One point has moved: the model no longer counts as posed.
  EXPECT_EQ(run(node, depth_image(3, {nullptr, 0}), progress), 0);
  EXPECT_GT(run(node, depth_image(4, {&shown_, 1}), progress), posing_steps());
  EXPECT_EQ(progress.followed, 1);
  EXPECT_EQ(progress.inconclusive, 1);
}

TEST_F(FollowRobotTest, IsNotReadyWithoutPosesOfAllItsLinks) {
  LinkPoses one = given_;
  one.count = 1;
  FollowRobot node = this->node(k_all, {&given_, 0});
  node.links = {&one, 0};
  EXPECT_EQ(node.prepare(), Reason::out_of_range);
  node.links = {};
  EXPECT_EQ(node.prepare(), Reason::not_prepared);
}

TEST_F(FollowRobotTest, StatesWhenAndWhereItWasFollowed) {
  FollowRobot node = this->node(k_all, {&shown_, 1});
  RobotProgress progress;
  run(node, depth_image(3, {&shown_, 1}), progress);
  EXPECT_EQ(progress.last, FollowOutcome::followed);
  EXPECT_EQ(progress.time, Time{} + milliseconds(300));
  EXPECT_EQ(progress.frame.state, RegistrationState::accepted);
  EXPECT_FALSE(progress.frame.in_reference);
  EXPECT_GT(progress.frame.rms_m, 0);
  EXPECT_LT(progress.frame.rms_m, 0.005);
  EXPECT_LT((progress.frame.T_world_robot.translation - k_truth.translation).norm(), 0.004);
}

// A jump is rejected. The node reports its size and keeps the last accepted state.
TEST_F(FollowRobotTest, CountsAJumpAndStaysWhereItWas) {
  FollowRobot node = this->node(k_all, {&shown_, 1});
  node.T_world_robot.translation = k_truth.translation + Vector3(0.03, 0, 0);
  ASSERT_EQ(node.prepare(), Reason::none);
  RobotProgress progress;
  run(node, depth_image(1, {&shown_, 1}), progress);
  EXPECT_EQ(progress.last, FollowOutcome::jumped) << name_of(progress.last);
  EXPECT_EQ(progress.jumps, 1);
  EXPECT_EQ(progress.followed + progress.inconclusive, 0);
  EXPECT_NEAR(progress.translation_m, 0.03, 0.005);
  EXPECT_LT(progress.rotation_rad, 0.02);
  EXPECT_EQ(progress.time, Time{});
  EXPECT_EQ(progress.frame.state, RegistrationState::none);
}

TEST_F(FollowRobotTest, CountsAPictureThatShowsTooLittle) {
  FollowRobot node = this->node(k_all, {&shown_, 1});
  RobotProgress progress;
  run(node, depth_image(1, {&shown_, 1}), progress);
  ASSERT_EQ(progress.followed, 1);
  std::fill(depth_.begin(), depth_.end(), 0.4f);  // a hand in front of the lens
  run(node, depth_image(2, {&shown_, 1}), progress);
  EXPECT_NE(progress.last, FollowOutcome::followed);
  EXPECT_EQ(progress.followed, 1);
  EXPECT_EQ(progress.inconclusive, 1);
  EXPECT_EQ(progress.jumps, 0);
  EXPECT_EQ(progress.time, Time{} + milliseconds(100));
}

TEST_F(FollowRobotTest, LooksAtEachPictureOnceAndAtNoneWithoutAModelOrSteps) {
  FollowRobot node = this->node(k_all, {&shown_, 1});
  RobotProgress progress;
  EXPECT_GT(run(node, depth_image(1, {&shown_, 1}), progress), 0);
  EXPECT_EQ(run(node, depth_image(1, {&shown_, 1}), progress), 0);
  EXPECT_EQ(progress.followed, 1);
  ShownDepth empty = depth_image(2, {&shown_, 1});
  empty.scene.depth_m = {};
  EXPECT_EQ(run(node, empty, progress), 0) << "no robot is looked for";
  FollowRobot none;
  none.limits.tracking_steps = k_all;
  ASSERT_EQ(none.prepare(), Reason::none);
  EXPECT_EQ(run(none, depth_image(1, {&shown_, 1}), progress), 0);
  EXPECT_EQ(progress.followed + progress.inconclusive + progress.jumps, 0);
  EXPECT_EQ(none.counts(), (graph::LoopCounts{{1, 0}}));
  FollowRobot still = this->node(0, {&shown_, 1});
  EXPECT_EQ(run(still, depth_image(1, {&shown_, 1}), progress), 0);
  EXPECT_EQ(progress.followed, 0);
  EXPECT_EQ(FollowRobot::worst(still.limits), (graph::LoopCounts{{1, 0}}));
  still.limits.tracking_steps = 7;
  EXPECT_EQ(FollowRobot::worst(still.limits),
            (graph::LoopCounts{{1, 7 + k_follow_item_steps_max}}));
}

TEST_F(FollowRobotTest, IsPosedWithoutTheHeap) {
  FollowRobot node = this->node(5'000, {&given_, 0});
  const ShownDepth shown = depth_image(1, {&shown_, 1});
  RobotProgress progress;
  const HeapCount heap;
  do {
    node(shown, progress);
  } while (!progress.free);
  EXPECT_EQ(heap.count(), 0u);
  EXPECT_EQ(progress.followed, 1);
}

}  // namespace
}  // namespace glint
