// What the last pictures said of the robot that is followed, for whoever reports it from another
// thread.
#pragma once

#include <atomic>
#include <cstdint>

namespace glint {

struct FollowedRobotNotes {
  std::atomic<std::int64_t> followed{0}, jumps{0}, unsure{0};  // pictures so far
  std::atomic<double> shift_m{0}, turn_rad{0};                 // of the last jump
  std::atomic<bool> jumped{false};              // and none that was followed came after it
  std::atomic<std::int64_t> without_joints{0};  // pictures passed over: what was heard is too old
  std::atomic<bool> joints_lost{false};         // the last picture is one of them
};

}  // namespace glint
