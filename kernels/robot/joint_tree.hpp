// Kinematic tree of a robot's joints with fixed capacity: the content of a URDF that forward
// kinematics needs.
#pragma once

#include <array>
#include <cstdint>

#include "kernels/geometry.hpp"

namespace glint {

inline constexpr int k_robot_joints_max = 256;
inline constexpr int k_robot_links_max = k_robot_joints_max + 1;

enum class JointKind : std::uint8_t { fixed, revolute, prismatic };  // revolute includes continuous

// Joint i carries link i + 1; link 0 is the root.
struct TreeJoint {
  Pose T_parent_joint;              // in the parent link, at position zero
  Vector3 axis = Vector3::UnitX();  // unit length, in the joint's frame
  JointKind kind = JointKind::fixed;
  int parent_link = 0;  // at most this joint's own index: parents precede children
  int input = -1;       // index of the value that moves it; several may share one (mimic)
  double multiplier = 1, offset = 0;  // position = multiplier * value + offset: radians or metres
};

struct JointTree {
  std::array<TreeJoint, k_robot_joints_max> joints;
  int joint_count = 0;
  int input_count = 0;
};

}  // namespace glint
