// What a background group hears and says of the robot that it follows.
#include <gtest/gtest.h>

#include "platform/rt/allocation_counter.hpp"
#include "platform/session/background_group.hpp"
#include "tests/unit/platform/session/followed_robot.hpp"
#include "tests/unit/platform/session/short_run.hpp"

namespace glint {
namespace {

Time at_ms(std::int64_t number) { return Time{} + milliseconds(number); }

// The robot jumps in the seventh of twelve pictures; to and fro, the eighteenth shows it back.
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

constexpr double k_heard_m = 0.1;

// The box on a slide: its model stands where the pictures show it when the slide is at k_heard_m.
RobotCloud on_a_slide(const std::string& path) {
  RobotCloud robot = read_robot_cloud(path);
  robot.links.push_back("carriage");
  robot.inputs = {"slide"};
  TreeJoint& slide = robot.tree.joints[0];
  slide.kind = JointKind::sliding;
  slide.axis = Vector3::UnitX();
  slide.input = 0;
  robot.tree.joint_count = robot.tree.input_count = 1;
  robot.point_links.assign(robot.points.size(), 1);
  for (Vector3f& point : robot.points) point.x() -= static_cast<float>(k_heard_m);
  return robot;
}

void say(graph::TripleBuffer<HeardJoints>& heard, const std::vector<std::string>& names,
         const std::vector<double>& positions) {
  HeardJoints& joints = heard.write_slot();
  joints = {};
  joints.count = static_cast<int>(names.size());
  for (std::size_t i = 0; i < names.size(); ++i) {
    names[i].copy(joints.names[i].data(), k_heard_name_max);
    joints.positions[i] = positions[i];
  }
  heard.publish(heard.version() + 1, 0);
}

TEST(HeardJointsOfARobot, PoseItsModelInPlaceOfTheCells) {
  const TemporaryFolder folder;
  Cell cell = short_cell(1);
  follow_a_box(folder.path(), 0, cell);
  write_robot_cloud(cell.mapping->model, on_a_slide(cell.mapping->model));
  cell.mapping->joints = {0};
  const auto followed = [&](graph::TripleBuffer<HeardJoints>* heard) {
    BackgroundGroup group(cell, *plan_by_rule(cell).background, nullptr,
                          read_background_scene(cell, nullptr));
    if (heard != nullptr) group.hear(*heard);
    group.reach(at_ms(750));
    EXPECT_EQ(group.counts().joints_used, heard != nullptr ? 1 : 0);
    return group.counts().robot.followed;
  };
  EXPECT_EQ(followed(nullptr), 0);
  graph::TripleBuffer<HeardJoints> heard;
  say(heard, {"gripper", "slide"}, {7, k_heard_m});
  EXPECT_GE(followed(&heard), 5);
}

TEST(HeardJointsOfARobot, ArePassedOverAndCountedWhereOneIsMissing) {
  const TemporaryFolder folder;
  Cell cell = short_cell(1);
  follow_a_box(folder.path(), 0, cell);
  const RobotCloud model = on_a_slide(cell.mapping->model);
  const std::vector<double> given = {0.02};
  const PosedCloud posed = posed_cloud(model, given, "a test");
  HeardRobot robot(model, posed);
  const auto stands_at = [&](double position) {
    const std::vector<double> positions = {position};
    const std::span<const Vector3f> points = robot.cloud().points;
    return std::vector(points.begin(), points.end()) ==
           posed_cloud(model, positions, "a test").points;
  };
  graph::TripleBuffer<HeardJoints> heard;
  robot.update(heard);
  EXPECT_TRUE(stands_at(0.02));
  EXPECT_EQ(robot.lacking(), nullptr);
  say(heard, {"gripper"}, {7});
  robot.update(heard);
  EXPECT_TRUE(stands_at(0.02));
  ASSERT_NE(robot.lacking(), nullptr);
  EXPECT_EQ(*robot.lacking(), "slide");
  say(heard, {"slide"}, {0.3});
  say(heard, {"slide"}, {0.4});
  const std::uint64_t before = AllocationCounter::count();
  AllocationCounter::arm();
  robot.update(heard);
  AllocationCounter::disarm();
  EXPECT_TRUE(AllocationCounter::available());
  EXPECT_EQ(AllocationCounter::count(), before);
  EXPECT_TRUE(stands_at(0.4));
  robot.update(heard);
  EXPECT_EQ(robot.used(), 1);
  EXPECT_EQ(robot.passed_over(), 1);
}

}  // namespace
}  // namespace glint
