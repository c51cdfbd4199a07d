#include "kernels/robot/forward_kinematics.hpp"

#include "kernels/elementary.hpp"

namespace glint {
namespace {

double position_of(const TreeJoint& joint, std::span<const double> values) noexcept {
  if (joint.input < 0) return joint.offset;
  return joint.multiplier * values[static_cast<std::size_t>(joint.input)] + joint.offset;
}

bool is_position(double value) noexcept {
  return value >= -k_joint_position_max && value <= k_joint_position_max;  // false for NaN
}

Reason check(const JointTree& tree, std::span<const double> values) noexcept {
  if (tree.joint_count < 0 || tree.joint_count > k_robot_joints_max) return Reason::not_prepared;
  if (values.size() != static_cast<std::size_t>(tree.input_count)) return Reason::out_of_range;
  for (int i = 0; i < tree.joint_count; ++i) {
    const TreeJoint& joint = tree.joints[static_cast<std::size_t>(i)];
    const bool ordered = joint.parent_link >= 0 && joint.parent_link <= i;
    if (!ordered || joint.input >= tree.input_count) return Reason::not_prepared;
    if (!is_position(position_of(joint, values))) return Reason::out_of_range;
  }
  return Reason::none;
}

Pose motion_of(const TreeJoint& joint, double position) noexcept {
  Pose motion;
  if (joint.kind == JointKind::revolute) {
    const SineCosine half = sine_cosine(0.5 * position);
    const Vector3 v = half.sine * joint.axis;
    motion.rotation = Quaternion(half.cosine, v.x(), v.y(), v.z());
  } else if (joint.kind == JointKind::prismatic) {
    motion.translation = position * joint.axis;
  }
  return motion;
}

}  // namespace

Reason forward_kinematics(const JointTree& tree, std::span<const double> values,
                          LinkPoses& poses) noexcept {
  const Reason reason = check(tree, values);
  if (reason != Reason::none) return reason;
  poses.T_root_link[0] = Pose{};
  poses.count = tree.joint_count + 1;
  for (int i = 0; i < tree.joint_count; ++i) {
    const TreeJoint& joint = tree.joints[static_cast<std::size_t>(i)];
    const Pose& parent = poses.T_root_link[static_cast<std::size_t>(joint.parent_link)];
    poses.T_root_link[static_cast<std::size_t>(i) + 1] =
        parent * (joint.T_parent_joint * motion_of(joint, position_of(joint, values)));
  }
  return Reason::none;
}

}  // namespace glint
