#include "kernels/robot/forward_kinematics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace glint {
namespace {

JointTree two_bars() {  // a metre along x, turning about z, then one more with a slide at its end
  JointTree tree;
  tree.joint_count = 3;
  tree.input_count = 2;
  tree.joints[0] = {{}, Vector3::UnitZ(), JointKind::turning, 0, 0, 1, 0};
  tree.joints[1] = {
      {Quaternion::Identity(), Vector3::UnitX()}, Vector3::UnitZ(), JointKind::turning, 1, 1, 1, 0};
  tree.joints[2] = {{Quaternion::Identity(), Vector3::UnitX()},
                    Vector3::UnitY(),
                    JointKind::sliding,
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
  // The second turn takes the first back: the slide, half of -pi/2 and a quarter, is along y again.
  EXPECT_LT((poses.T_root_link[3].translation - Vector3(1, 1 - M_PI / 4 + 0.25, 0)).norm(), 1e-14);
}

TEST(ForwardKinematics, HoldsAJointWithoutInputAtItsOffset) {
  JointTree tree = two_bars();
  tree.joints[2].input = -1;
  LinkPoses poses, not_moved;
  const std::vector<double> values{1e300, 0.4, -0.3};
  const auto given = std::span(values).subspan(1);  // what lies in front is none of them
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
                                                JointKind::turning,
                                                i,
                                                0,
                                                1,
                                                0};
  }
  LinkPoses poses;
  // A full turn in all: a regular polygon closes.
  const std::vector<double> value{2 * M_PI / k_robot_joints_max};
  ASSERT_EQ(forward_kinematics(tree, value, poses), Reason::none);
  const Pose& last = poses.T_root_link[k_robot_joints_max];
  EXPECT_LT((last.translation).norm(), 1e-10);
  EXPECT_NEAR(last.rotation.norm(), 1, 1e-14);
}

}  // namespace
}  // namespace glint
