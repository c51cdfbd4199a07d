// Camera pose of the headset at a frame's mid-exposure, from the headset's own localisation.
#pragma once

#include "kernels/geometry.hpp"
#include "kernels/units.hpp"

namespace glint {

struct HeadPose {
  Time time;           // the frame's mid_exposure; the pose is already interpolated to it
  bool valid = false;  // false: the tool's pose is valid in the camera's frame only
  Pose T_world_camera;
};

}  // namespace glint
