// Forward kinematics of a robot: the pose of every link from the joint positions.
//
// What:     T_root_link(i + 1) = T_root_link(parent) * T_parent_joint * motion(position).
// Cost:     a sine and cosine and two products of poses for each joint.
// Worst:    k_robot_joints_max revolute joints; all revolute joints cost the same.
// Accuracy: 1e-14 a joint of a metre's length; against Orocos KDL within 1e-9.
// Source:   URDF's definition of a joint; Craig 2005, Introduction to Robotics, equation (3.6) is
//           the same product with other parameters.
#pragma once

#include <array>
#include <span>

#include "kernels/nonblocking.hpp"
#include "kernels/reason.hpp"
#include "kernels/robot/joint_tree.hpp"

namespace glint {

// Largest joint position accepted; also the range of sine_cosine().
inline constexpr double k_joint_position_max = 1e5;

struct LinkPoses {
  std::array<Pose, k_robot_links_max> T_root_link;
  int count = 0;
};

// values: radians or metres, one for each input. Reason::out_of_range: wrong number of values, or
// one that is not finite or beyond k_joint_position_max. Reason::not_prepared: a tree whose parents
// do not precede their children. On an error `poses` is unchanged.
[[nodiscard]] Reason forward_kinematics(const JointTree& tree, std::span<const double> values,
                                        LinkPoses& poses) noexcept GLINT_NONBLOCKING;

}  // namespace glint
