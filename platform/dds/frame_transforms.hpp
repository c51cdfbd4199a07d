// What a frame tells tf: where the headset is, and a robot that stands where a body is seen.
#pragma once

#include "kernels/geometry.hpp"
#include "kernels/pose/head_pose.hpp"

namespace glint {

struct FrameTransforms {
  HeadPose head;
  bool robot_known = false;  // false also for one that stands in the world: tf_static's
  Pose T_world_robot;
};

}  // namespace glint
