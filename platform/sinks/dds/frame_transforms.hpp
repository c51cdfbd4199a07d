// Transforms of a frame for tf: the headset's pose, and the robot's if it is mounted on the
// reference body.
#pragma once

#include "kernels/geometry.hpp"
#include "kernels/pose/head_pose.hpp"

namespace glint {

struct FrameTransforms {
  HeadPose head;
  bool robot_valid = false;  // false also for a robot fixed in the world: tf_static has it
  Pose T_world_robot;
};

}  // namespace glint
