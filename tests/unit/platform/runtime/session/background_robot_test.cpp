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
  follow_a_box(folder.path(), 0.03, cell);
  FollowedRobotNotes notes;
  BackgroundGroup group(cell, *plan_by_rule(cell).background, nullptr,
                        read_background_scene(cell, nullptr), {nullptr, nullptr, &notes});
  group.reach(at_ms(650));
  EXPECT_GE(notes.followed, 5);
  EXPECT_FALSE(notes.jumped);
  group.reach(at_ms(1150));
  EXPECT_TRUE(notes.jumped);
  EXPECT_GE(notes.jumps, 2);
  EXPECT_NEAR(notes.shift_m, 0.03, 0.01);
  group.reach(at_ms(2150));
  EXPECT_FALSE(notes.jumped);
  EXPECT_GT(notes.followed, 7);
}

void say(graph::TripleBuffer<HeardJoints>& heard, const std::vector<std::string>& names,
         const std::vector<double>& positions, Time arrival = {}) {
  HeardJoints& joints = heard.write_slot();
  joints = {};
  joints.time = at_ms(1'000'000);  // another machine's time stamp: must be ignored
  joints.count = static_cast<int>(names.size());
  for (std::size_t i = 0; i < names.size(); ++i) {
    names[i].copy(joints.names[i].data(), k_heard_name_max);
    joints.positions[i] = positions[i];
  }
  heard.publish(heard.version() + 1, arrival.nanoseconds);
}

TEST(HeardJointsOfARobot, PoseItsModelInPlaceOfTheCells) {
  const TemporaryFolder folder;
  Cell cell = short_cell(1);
  follow_a_box_on_a_slide(folder.path(), cell);
  const auto followed = [&](graph::TripleBuffer<HeardJoints>* heard) {
    BackgroundGroup group(cell, *plan_by_rule(cell).background, nullptr,
                          read_background_scene(cell, nullptr));
    if (heard != nullptr) group.hear(*heard);
    group.reach(at_ms(750));
    EXPECT_EQ(group.counts().joints_used, heard != nullptr ? 1 : 0);
    EXPECT_LE(group.counts().longest_steps,
              k_background_steps_max + std::max(k_map_item_steps_max, k_follow_item_steps_max));
    return group.counts().robot.followed;
  };
  EXPECT_EQ(followed(nullptr), 0);
  graph::TripleBuffer<HeardJoints> heard;
  say(heard, {"gripper", "slide"}, {7, k_slide_shown_m});
  EXPECT_GE(followed(&heard), 5);
}

// One image every 100 ms.
TEST(HeardJointsOfARobot, AreNotFollowedByOnceTheyAreTooOld) {
  const TemporaryFolder folder;
  Cell cell = short_cell(1);
  follow_a_box_on_a_slide(folder.path(), cell);
  cell.mapping->joints_lost_after = milliseconds(250);
  FollowedRobotNotes notes;
  BackgroundGroup group(cell, *plan_by_rule(cell).background, nullptr,
                        read_background_scene(cell, nullptr), {nullptr, nullptr, &notes});
  graph::TripleBuffer<HeardJoints> heard;
  group.hear(heard);
  group.reach(at_ms(350));  // configured joint values do not expire
  EXPECT_EQ(group.counts().pictures_without_joints, 0);
  say(heard, {"slide"}, {k_slide_shown_m}, at_ms(350));
  group.reach(at_ms(690));
  const std::int64_t followed = group.counts().robot.followed;
  EXPECT_GE(followed, 1);
  EXPECT_FALSE(notes.joints_lost);
  EXPECT_EQ(group.counts().pictures_without_joints, 0);
  group.reach(at_ms(1190));  // more than 250 ms older than every image from 700 ms on
  const std::int64_t without = group.counts().pictures_without_joints;
  EXPECT_GE(without, 4);
  EXPECT_EQ(group.without_joints(), without);
  EXPECT_EQ(notes.without_joints, without);
  EXPECT_TRUE(notes.joints_lost);
  EXPECT_LE(group.counts().robot.followed, followed + 1);  // one was in progress
  say(heard, {"gripper"}, {7}, at_ms(1190));               // does not contain the slide
  group.reach(at_ms(1290));
  EXPECT_GT(group.counts().pictures_without_joints, without);
  say(heard, {"slide"}, {k_slide_shown_m}, at_ms(1300));
  group.reach(at_ms(1590));
  EXPECT_FALSE(notes.joints_lost);
  EXPECT_GE(group.counts().robot.followed, followed + 2);
}

// The box's model on a slide, and the receiver of the slide's joint value.
class HeardJointsOfASlide : public testing::Test {
 protected:
  RobotCloud box_on_a_slide() {
    follow_a_box(folder_.path(), 0, cell_);
    return on_a_slide(cell_.mapping->model);
  }
  [[nodiscard]] LinkPoses poses_at(double position) const {
    const std::vector<double> positions = {position};
    return link_poses(model_, positions, "a test");
  }
  [[nodiscard]] bool stands_at(double position) const {
    const LinkPoses &poses = *robot_.links().poses, expected = poses_at(position);
    EXPECT_EQ(poses.count, expected.count);
    const Pose &carriage = poses.T_root_link[1], &there = expected.T_root_link[1];
    return carriage.translation == there.translation && carriage.rotation.isApprox(there.rotation);
  }

  const TemporaryFolder folder_;
  Cell cell_ = short_cell(1);
  graph::TripleBuffer<HeardJoints> heard_;
  const RobotCloud model_ = box_on_a_slide();
  HeardRobot robot_{model_, poses_at(0.02), milliseconds(1000)};
};

TEST_F(HeardJointsOfASlide, ArePassedOverAndCountedWhereOneIsMissing) {
  robot_.update(heard_);
  EXPECT_TRUE(stands_at(0.02));
  EXPECT_EQ(robot_.lacking(), nullptr);
  say(heard_, {"gripper"}, {7});
  robot_.update(heard_);
  EXPECT_TRUE(stands_at(0.02));
  EXPECT_EQ(robot_.links().number, 0u) << "posed anew by nothing";
  ASSERT_NE(robot_.lacking(), nullptr);
  EXPECT_EQ(*robot_.lacking(), "slide");
  say(heard_, {"slide"}, {0.3});
  robot_.update(heard_);
  EXPECT_TRUE(stands_at(0.3));
  EXPECT_EQ(robot_.links().number, 1u);
  EXPECT_EQ(robot_.used(), 1);
  EXPECT_EQ(robot_.passed_over(), 1);
}

TEST_F(HeardJointsOfASlide, ArePassedOverWithTheReasonWhereTheyCannotBe) {
  say(heard_, {"slide"}, {2 * k_joint_position_max});
  robot_.update(heard_);
  EXPECT_TRUE(stands_at(0.02));
  EXPECT_EQ(robot_.passed_over(), 1);
  EXPECT_EQ(robot_.lacking(), nullptr);
  EXPECT_EQ(robot_.unusable(), Reason::out_of_range);
}

TEST_F(HeardJointsOfASlide, PoseItByTheNewestStateOnceAndWithoutMemory) {
  say(heard_, {"slide"}, {0.3});
  say(heard_, {"slide"}, {0.4});
  {
    const HeapCount heap;
    robot_.update(heard_);
    EXPECT_EQ(heap.count(), 0u);
  }
  EXPECT_TRUE(stands_at(0.4));
  robot_.update(heard_);
  EXPECT_EQ(robot_.used(), 1);
}

}  // namespace
}  // namespace glint
