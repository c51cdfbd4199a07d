#include "kernels/robot/forward_kinematics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace glint {
namespace {

JointTree two_bars() {  // 1 m along x, revolute about z; the same again, with a slide at its end
  JointTree tree;
  tree.joint_count = 3;
  tree.input_count = 2;
  tree.joints[0] = {{}, Vector3::UnitZ(), JointKind::revolute, 0, 0, 1, 0};
  tree.joints[1] = {{Quaternion::Identity(), Vector3::UnitX()},
                    Vector3::UnitZ(),
                    JointKind::revolute,
                    1,
                    1,
                    1,
                    0};
  tree.joints[2] = {{Quaternion::Identity(), Vector3::UnitX()},
                    Vector3::UnitY(),
                    JointKind::prismatic,
                    2,
                    1,
                    0.5,
                    0.25};
  return tree;
}

TEST(ForwardKinematics, FollowsBarsThatTurnAndSlide) {
  LinkPoses poses;
  const std::vector<double> values{M_PI / 2, -M_PI / 2};
  ASSERT_EQ(forward_kinematics(two_bars(), values, poses), Reason::none);
  ASSERT_EQ(poses.count, 4);
  EXPECT_LT((poses.T_root_link[2].translation - Vector3(0, 1, 0)).norm(), 1e-14);
  // The second rotation cancels the first: the slide, half of -pi/2 plus 0.25, is along y again.
  EXPECT_LT((poses.T_root_link[3].translation - Vector3(1, 1 - M_PI / 4 + 0.25, 0)).norm(), 1e-14);
}

TEST(ForwardKinematics, HoldsAJointWithoutInputAtItsOffset) {
  JointTree tree = two_bars();
  tree.joints[2].input = -1;
  LinkPoses poses, not_moved;
  const std::vector<double> values{1e300, 0.4, -0.3};
  const auto given = std::span(values).subspan(1);  // the value in front is not part of it
  ASSERT_EQ(forward_kinematics(tree, given, poses), Reason::none);
  tree.joints[2].offset = 0;
  ASSERT_EQ(forward_kinematics(tree, given, not_moved), Reason::none);
  const Vector3 moved = poses.T_root_link[3].translation - not_moved.T_root_link[3].translation;
  EXPECT_NEAR(moved.norm(), 0.25, 1e-14);
}

TEST(ForwardKinematics, RefusesTooFewValuesAndThoseThatAreNone) {
  LinkPoses poses;
  poses.count = 7;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(forward_kinematics(two_bars(), std::vector<double>{1}, poses), Reason::out_of_range);
  EXPECT_EQ(forward_kinematics(two_bars(), std::vector<double>{1, nan}, poses),
            Reason::out_of_range);
  EXPECT_EQ(forward_kinematics(two_bars(), std::vector<double>{1, 1e6}, poses),
            Reason::out_of_range);
  EXPECT_EQ(poses.count, 7);
}

TEST(ForwardKinematics, RefusesAParentBehindItsChild) {
  JointTree tree = two_bars();
  tree.joints[1].parent_link = 2;
  LinkPoses poses;
  EXPECT_EQ(forward_kinematics(tree, std::vector<double>{0, 0}, poses), Reason::not_prepared);
}

TEST(ForwardKinematics, StaysRigidOverTheLongestChain) {
  JointTree tree;
  tree.joint_count = k_robot_joints_max;
  tree.input_count = 1;
  for (int i = 0; i < k_robot_joints_max; ++i) {
    tree.joints[static_cast<std::size_t>(i)] = {{Quaternion::Identity(), Vector3::UnitX()},
                                                Vector3::UnitZ(),
                                                JointKind::revolute,
                                                i,
                                                0,
                                                1,
                                                0};
  }
  LinkPoses poses;
  // One full rotation in total: a regular polygon closes.
  const std::vector<double> value{2 * M_PI / k_robot_joints_max};
  ASSERT_EQ(forward_kinematics(tree, value, poses), Reason::none);
  const Pose& last = poses.T_root_link[k_robot_joints_max];
  EXPECT_LT((last.translation).norm(), 1e-10);
  EXPECT_NEAR(last.rotation.norm(), 1, 1e-14);
}

// Each kind of joint, on a separate branch.
TEST(ForwardKinematics, MovesEachKindOfJointByItsPosition) {
  const Pose at{Quaternion(Eigen::AngleAxisd(0.5, Vector3(1, 1, 0).normalized())), {0.1, 0.2, 0.3}};
  const Vector3 axis = Vector3(2, -1, 3).normalized();
  JointTree tree;
  tree.joint_count = 4;
  tree.input_count = 2;
  tree.joints[0] = {at, axis, JointKind::revolute, 0, 1, -2, 0.25};
  tree.joints[1] = {at, axis, JointKind::prismatic, 0, 1, 3, -0.5};
  tree.joints[2] = {at, axis, JointKind::fixed, 1, 0, 1, 0};
  tree.joints[3] = {at, axis, JointKind::revolute, 2, -1, 7, 0.125};
  LinkPoses poses;
  poses.T_root_link[0].translation = Vector3(9, 9, 9);
  const std::vector<double> values{40, 0.75};
  ASSERT_EQ(forward_kinematics(tree, values, poses), Reason::none);
  ASSERT_EQ(poses.count, 5);
  const auto turned = [&](double by) {
    return Pose{Quaternion(Eigen::AngleAxisd(by, axis)), Vector3::Zero()};
  };
  const Pose slid{Quaternion::Identity(), (3 * 0.75 - 0.5) * axis};
  const Pose expected[] = {{},
                           at * turned(-2 * 0.75 + 0.25),
                           at * slid,
                           at * turned(-2 * 0.75 + 0.25) * at,
                           at * slid * at * turned(0.125)};
  for (std::size_t link = 0; link < 5; ++link) {
    const Pose& found = poses.T_root_link[link];
    EXPECT_LT((found.translation - expected[link].translation).norm(), 1e-14) << link;
    EXPECT_LT(
        (found.rotation.toRotationMatrix() - expected[link].rotation.toRotationMatrix()).norm(),
        1e-14)
        << link;
  }
}

TEST(ForwardKinematics, TakesEachPositionUpToItsLimit) {
  const double beyond = std::nextafter(k_joint_position_max, 1e9);
  const auto reason_of = [](int joint, double value, double offset = 0) {
    JointTree tree = two_bars();
    tree.joints[2] = {{}, Vector3::UnitX(), JointKind::prismatic, 2, joint < 0 ? -1 : 1, 2, offset};
    LinkPoses poses;
    return forward_kinematics(tree, std::vector<double>{0, value}, poses);
  };
  for (const double side : {-1.0, 1.0}) {
    EXPECT_EQ(reason_of(1, side * k_joint_position_max / 2), Reason::none);
    EXPECT_EQ(reason_of(1, side * beyond / 2), Reason::out_of_range);
    EXPECT_EQ(reason_of(1, 0, side * k_joint_position_max), Reason::none);
    EXPECT_EQ(reason_of(1, 0, side * beyond), Reason::out_of_range);
    EXPECT_EQ(reason_of(-1, 0, side * k_joint_position_max), Reason::none);
    EXPECT_EQ(reason_of(-1, 0, side * beyond), Reason::out_of_range);
  }
}

TEST(ForwardKinematics, RefusesATreeThatIsNoneAndLeavesThePoses) {
  LinkPoses poses;
  poses.count = 7;
  for (Pose& pose : poses.T_root_link) pose.translation = Vector3(1, 2, 3);
  const auto reason_of = [&](auto change, std::size_t values = 2) {
    JointTree tree = two_bars();
    change(tree);
    const Reason reason = forward_kinematics(tree, std::vector<double>(values, 0.1), poses);
    EXPECT_EQ(poses.count, 7);
    for (const Pose& pose : poses.T_root_link) EXPECT_EQ(pose.translation, Vector3(1, 2, 3));
    return reason;
  };
  using T = JointTree;
  constexpr Reason wrong = Reason::not_prepared;
  EXPECT_EQ(reason_of([](T& t) { t.joint_count = -1; }), wrong);
  EXPECT_EQ(reason_of([](T& t) { t.joint_count = k_robot_joints_max + 1; }), wrong);
  EXPECT_EQ(reason_of([](T& t) { t.joints[0].parent_link = -1; }), wrong);
  EXPECT_EQ(reason_of([](T& t) { t.joints[0].parent_link = 1; }), wrong);
  EXPECT_EQ(reason_of([](T& t) { t.joints[2].parent_link = 3; }), wrong);
  EXPECT_EQ(reason_of([](T& t) { t.joints[2].input = 2; }), wrong);
  EXPECT_EQ(reason_of([](T& t) { t.input_count = 3; }), Reason::out_of_range);
  EXPECT_EQ(reason_of([](T&) {}, 3), Reason::out_of_range);
  EXPECT_EQ(reason_of([](T&) {}, 1), Reason::out_of_range);
  JointTree none;
  EXPECT_EQ(forward_kinematics(none, {}, poses), Reason::none) << "a root alone is a tree";
  EXPECT_EQ(poses.count, 1);
  EXPECT_EQ(poses.T_root_link[0].translation, Vector3(0, 0, 0));
  EXPECT_EQ(poses.T_root_link[1].translation, Vector3(1, 2, 3));
}

}  // namespace
}  // namespace glint
