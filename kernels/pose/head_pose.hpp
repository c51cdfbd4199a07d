// Where the headset's camera was at a frame's mid-exposure, by the headset's own localisation.
#pragma once

#include "kernels/geometry.hpp"
#include "kernels/units.hpp"

namespace glint {

struct HeadPose {
  Time time;           // equals the frame's mid_exposure: already interpolated to it
  bool valid = false;  // without it the tool's pose still holds in the camera's frame
  Pose T_world_camera;
};

}  // namespace glint
