// A version of where the robot is, as the tick group could read it: what re-referencing found while
// the session ran.
#pragma once

#include <cstdint>

#include "kernels/geometry.hpp"
#include "kernels/units.hpp"
#include "kernels/wire/pose_sample.hpp"

namespace glint {

struct RobotFrameRecord {
  std::uint64_t version = 0;  // as a tick's choice names it
  Time time;                  // of the picture that it rests on
  RegistrationState state = RegistrationState::none;
  Pose T_world_robot;
  double rms_m = 0;
  bool in_reference = false;  // T_world_robot leads to the reference body's frame
};

}  // namespace glint
