// Version of the robot's pose, as an input of the tick group: result of re-referencing during the
// session.
#pragma once

#include <cstdint>

#include "kernels/geometry.hpp"
#include "kernels/units.hpp"
#include "kernels/wire/pose_sample.hpp"

namespace glint {

struct RobotFrameRecord {
  std::uint64_t version = 0;  // referenced by a tick's choice
  Time time;                  // of the image it is based on
  RegistrationState state = RegistrationState::none;
  Pose T_world_robot;
  double rms_m = 0;
  bool in_reference = false;  // T_world_robot leads to the reference body's frame
};

}  // namespace glint
