// Results of robot pose tracking, published to reporting threads.
#pragma once

#include <atomic>
#include <cstdint>

namespace glint {

struct RobotTrackingStatus {
  std::atomic<std::int64_t> followed{0}, jumps{0}, inconclusive{0};  // images so far
  std::atomic<double> translation_m{0}, rotation_rad{0};             // of the last jump
  std::atomic<bool> jumped{false};  // true until an image is followed after a jump
  std::atomic<std::int64_t> skipped_without_joints{0};  // images: joint states too old
  std::atomic<bool> joints_lost{false};                 // the last image was skipped
};

}  // namespace glint
