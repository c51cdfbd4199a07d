// Point-level pose measurements of a moving tool at a constant rate, shared by rest, lag and sine.
#pragma once

#include <cstdint>
#include <functional>

#include "platform/lab/experiments/point_fit.hpp"

namespace glint {

// Frame times at 45 Hz, from time 0 on.
[[nodiscard]] constexpr Time frame_time(int frame) { return Time{} + Duration{22'222'222} * frame; }

// Pose at the start of a run: the mean of the markers at 0.5 m, their plane's normal tilted from
// the line of sight, otherwise random.
[[nodiscard]] Pose held_pose(double tilt_rad, std::uint64_t seed, std::uint64_t run);

// Returns a random unit vector.
[[nodiscard]] Vector3 direction(std::uint64_t seed, std::uint64_t run, std::uint64_t which);

struct PointNoise {
  double share = 1;  // factor on the camera's sigmas; 0: noise-free, covariance as declared
  std::uint64_t seed = 1;
  std::uint64_t run = 0;
};

// Returns the pose measured at frame `frame` of the run, or the reason for none.
[[nodiscard]] Result<UncertainPose> measure(const PointCamera& camera,
                                            const std::vector<Vector3>& model_m, const Pose& truth,
                                            const PointNoise& noise, std::uint64_t frame);

}  // namespace glint
