// Background group with a tracked robot: joint states received, status published.
#include <gtest/gtest.h>

#include <algorithm>

#include "platform/runtime/session/background_group.hpp"
#include "tests/unit/heap_count.hpp"
#include "tests/unit/platform/runtime/session/box_on_a_slide.hpp"
#include "tests/unit/platform/runtime/session/short_run.hpp"

namespace glint {
namespace {

Time at_ms(std::int64_t number) { return Time{} + milliseconds(number); }

// The robot jumps in the seventh of twelve images. They are played forward and backward, so the
// eighteenth shows it at its old pose.
TEST(RobotNotes, SayHowFarARobotJumpedUntilItIsSeenWhereItWas) {
  const TemporaryFolder folder;
  Cell cell = short_cell(1);
  configure_box_robot(folder.path(), 0.03, cell);
  RobotTrackingStatus notes;
  BackgroundGroup group(cell, *schedule_by_rule(cell).background, nullptr,
                        read_background_scene(cell, nullptr), {nullptr, nullptr, &notes});
  group.run_due_slices(at_ms(650));
  EXPECT_GE(notes.followed, 5);
  EXPECT_FALSE(notes.jumped);
  group.run_due_slices(at_ms(1150));
  EXPECT_TRUE(notes.jumped);
  EXPECT_GE(notes.jumps, 2);
  EXPECT_NEAR(notes.translation_m, 0.03, 0.01);
  group.run_due_slices(at_ms(2150));
  EXPECT_FALSE(notes.jumped);
  EXPECT_GT(notes.followed, 7);
}

void publish_joints(graph::TripleBuffer<ReceivedJoints>& joint_states,
                    const std::vector<std::string>& names, const std::vector<double>& positions,
                    Time arrival = {}) {
  ReceivedJoints& joints = joint_states.write_slot();
  joints = {};
  joints.time = at_ms(1'000'000);  // another machine's time stamp: must be ignored
  joints.count = static_cast<int>(names.size());
  for (std::size_t i = 0; i < names.size(); ++i) {
    names[i].copy(joints.names[i].data(), k_received_name_max);
    joints.positions[i] = positions[i];
  }
  joint_states.publish(joint_states.version() + 1, arrival.nanoseconds);
}

TEST(HeardJointsOfARobot, PoseItsModelInPlaceOfTheCells) {
  const TemporaryFolder folder;
  Cell cell = short_cell(1);
  configure_sliding_box(folder.path(), cell);
  const auto followed = [&](graph::TripleBuffer<ReceivedJoints>* joint_states) {
    BackgroundGroup group(cell, *schedule_by_rule(cell).background, nullptr,
                          read_background_scene(cell, nullptr));
    if (joint_states != nullptr) group.set_joint_source(*joint_states);
    group.run_due_slices(at_ms(750));
    EXPECT_EQ(group.counts().joints_used, joint_states != nullptr ? 1 : 0);
    EXPECT_LE(group.counts().longest_steps,
              k_background_steps_max + std::max(k_map_item_steps_max, k_follow_item_steps_max));
    return group.counts().robot.followed;
  };
  EXPECT_EQ(followed(nullptr), 0);
  graph::TripleBuffer<ReceivedJoints> joint_states;
  publish_joints(joint_states, {"gripper", "slide"}, {7, k_slide_shown_m});
  EXPECT_GE(followed(&joint_states), 5);
}

// One image every 100 ms.
TEST(HeardJointsOfARobot, AreNotFollowedByOnceTheyAreTooOld) {
  const TemporaryFolder folder;
  Cell cell = short_cell(1);
  configure_sliding_box(folder.path(), cell);
  cell.mapping->joints_lost_after = milliseconds(250);
  RobotTrackingStatus notes;
  BackgroundGroup group(cell, *schedule_by_rule(cell).background, nullptr,
                        read_background_scene(cell, nullptr), {nullptr, nullptr, &notes});
  graph::TripleBuffer<ReceivedJoints> joint_states;
  group.set_joint_source(joint_states);
  group.run_due_slices(at_ms(350));  // configured joint values do not expire
  EXPECT_EQ(group.counts().images_without_joints, 0);
  publish_joints(joint_states, {"slide"}, {k_slide_shown_m}, at_ms(350));
  group.run_due_slices(at_ms(690));
  const std::int64_t followed = group.counts().robot.followed;
  EXPECT_GE(followed, 1);
  EXPECT_FALSE(notes.joints_lost);
  EXPECT_EQ(group.counts().images_without_joints, 0);
  group.run_due_slices(at_ms(1190));  // more than 250 ms older than every image from 700 ms on
  const std::int64_t without = group.counts().images_without_joints;
  EXPECT_GE(without, 4);
  EXPECT_EQ(group.without_joints(), without);
  EXPECT_EQ(notes.skipped_without_joints, without);
  EXPECT_TRUE(notes.joints_lost);
  EXPECT_LE(group.counts().robot.followed, followed + 1);       // one was in progress
  publish_joints(joint_states, {"gripper"}, {7}, at_ms(1190));  // does not contain the slide
  group.run_due_slices(at_ms(1290));
  EXPECT_GT(group.counts().images_without_joints, without);
  publish_joints(joint_states, {"slide"}, {k_slide_shown_m}, at_ms(1300));
  group.run_due_slices(at_ms(1590));
  EXPECT_FALSE(notes.joints_lost);
  EXPECT_GE(group.counts().robot.followed, followed + 2);
}

// The box's model on a slide, and the receiver of the slide's joint value.
class HeardJointsOfASlide : public testing::Test {
 protected:
  RobotCloud box_on_a_slide() {
    configure_box_robot(folder_.path(), 0, cell_);
    return with_slide_joint(cell_.mapping->model);
  }
  [[nodiscard]] LinkPoses poses_at(double position) const {
    const std::vector<double> positions = {position};
    return link_poses(model_, positions, "a test");
  }
  [[nodiscard]] bool is_at(double position) const {
    const LinkPoses &poses = *robot_.links().poses, expected = poses_at(position);
    EXPECT_EQ(poses.count, expected.count);
    const Pose &carriage = poses.T_root_link[1], &there = expected.T_root_link[1];
    return carriage.translation == there.translation && carriage.rotation.isApprox(there.rotation);
  }

  const TemporaryFolder folder_;
  Cell cell_ = short_cell(1);
  graph::TripleBuffer<ReceivedJoints> joint_states_;
  const RobotCloud model_ = box_on_a_slide();
  RobotLinkPoses robot_{model_, poses_at(0.02), milliseconds(1000)};
};

TEST_F(HeardJointsOfASlide, ArePassedOverAndCountedWhereOneIsMissing) {
  robot_.update(joint_states_);
  EXPECT_TRUE(is_at(0.02));
  EXPECT_EQ(robot_.missing_joint(), nullptr);
  publish_joints(joint_states_, {"gripper"}, {7});
  robot_.update(joint_states_);
  EXPECT_TRUE(is_at(0.02));
  EXPECT_EQ(robot_.links().number, 0u) << "posed anew by nothing";
  ASSERT_NE(robot_.missing_joint(), nullptr);
  EXPECT_EQ(*robot_.missing_joint(), "slide");
  publish_joints(joint_states_, {"slide"}, {0.3});
  robot_.update(joint_states_);
  EXPECT_TRUE(is_at(0.3));
  EXPECT_EQ(robot_.links().number, 1u);
  EXPECT_EQ(robot_.used(), 1);
  EXPECT_EQ(robot_.skipped(), 1);
}

TEST_F(HeardJointsOfASlide, ArePassedOverWithTheReasonWhereTheyCannotBe) {
  publish_joints(joint_states_, {"slide"}, {2 * k_joint_position_max});
  robot_.update(joint_states_);
  EXPECT_TRUE(is_at(0.02));
  EXPECT_EQ(robot_.skipped(), 1);
  EXPECT_EQ(robot_.missing_joint(), nullptr);
  EXPECT_EQ(robot_.unusable(), Reason::out_of_range);
}

TEST_F(HeardJointsOfASlide, PoseItByTheNewestStateOnceAndWithoutMemory) {
  publish_joints(joint_states_, {"slide"}, {0.3});
  publish_joints(joint_states_, {"slide"}, {0.4});
  {
    const HeapCount heap;
    robot_.update(joint_states_);
    EXPECT_EQ(heap.count(), 0u);
  }
  EXPECT_TRUE(is_at(0.4));
  robot_.update(joint_states_);
  EXPECT_EQ(robot_.used(), 1);
}

}  // namespace
}  // namespace glint
