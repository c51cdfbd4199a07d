// Synthetic poses of a tool that pivots about its tip or rolls about its axis, with given noise.
#pragma once

#include <vector>

#include "kernels/motion/interpolate.hpp"
#include "platform/sim/random.hpp"

namespace glint::test {

struct PivotMotion {
  Vector3 tip_m{0.012, -0.034, 0.151};    // tool frame
  Vector3 post_m{0.1, -0.2, 0.5};         // tracker frame
  Vector3 tilt_rms_rad{0.35, 0.35, 0.3};  // about the tool's axes
  double position_sigma_m = 0;            // position noise of the centre, each axis
  double rotation_sigma_rad = 0;          // rotation noise, each axis
  Vector3 centre_m = Vector3::Zero();     // centre of the rotation noise, tool frame
  int repeats = 1;                        // copies of each pose
  std::uint64_t seed = 1;
};

inline sim::RandomKey turn_key(const PivotMotion& settings, std::uint64_t what) {
  return {settings.seed, sim::Stream::hand, what};
}

inline std::vector<TimedPose> pivot_poses(const PivotMotion& settings, int count) {
  std::vector<TimedPose> poses;
  for (int i = 0; i < count; ++i) {
    const auto index = static_cast<std::uint64_t>(i / settings.repeats);
    const Vector3 tilt = sim::gaussian_vector(turn_key(settings, 0), index);
    const Quaternion rotation = from_rotation_vector({0.3, -0.5, 0.8}) *
                                from_rotation_vector(settings.tilt_rms_rad.cwiseProduct(tilt));
    const Vector3 centre = settings.post_m + rotation * (settings.centre_m - settings.tip_m);
    const Quaternion measured =
        (rotation * from_rotation_vector(settings.rotation_sigma_rad *
                                         sim::gaussian_vector(turn_key(settings, 1), index)))
            .normalized();
    const Vector3 at =
        centre + settings.position_sigma_m * sim::gaussian_vector(turn_key(settings, 2), index);
    poses.push_back(
        {Time{std::int64_t{22'000'000} * i}, {measured, at - measured * settings.centre_m}});
  }
  return poses;
}

}  // namespace glint::test
