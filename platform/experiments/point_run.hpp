// A tool seen by its markers at a steady rate while it moves as told: what rest, lag and sine
// share.
#pragma once

#include <cstdint>
#include <functional>

#include "platform/experiments/point_fit.hpp"

namespace glint {

// 45 Hz, from time 0 on.
[[nodiscard]] constexpr Time frame_time(int frame) { return Time{} + Duration{22'222'222} * frame; }

// How a run's tool lies and turns: the middle of its markers at 0.5 m, their plane's normal tilted
// from the line of sight, the rest by chance.
[[nodiscard]] Pose held_pose(double tilt_rad, std::uint64_t seed, std::uint64_t run);

// A unit vector by chance.
[[nodiscard]] Vector3 direction(std::uint64_t seed, std::uint64_t run, std::uint64_t which);

struct PointNoise {
  double share = 1;  // of the camera's sigmas; 0: noise-free, the covariance stays as declared
  std::uint64_t seed = 1;
  std::uint64_t run = 0;
};

// The pose measured at frame `frame` of the run, or why there is none.
[[nodiscard]] Result<UncertainPose> measure(const PointCamera& camera,
                                            const std::vector<Vector3>& model_m, const Pose& truth,
                                            const PointNoise& noise, std::uint64_t frame);

}  // namespace glint
