// Simulated localisation of the headset with declared errors, and a simulated external reference
// tracker.
//
// The error is a small motion about a pivot ahead of the camera: visual localisation is fixed to
// the visible scene, so that rotation and translation errors compensate there.
//   at rest:   a first-order Gauss-Markov process (Ornstein and Uhlenbeck 1930): drift of the
//              inertial unit, bounded by the visible scene;
//   in motion: another, faster one in units of the speed. It is proportional to linear and angular
//              speed (smoothed over correlation_s), so its tails are heavier than a normal's;
//   latency:   the pose reported for time t is that of t - latency.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "platform/sim/motion.hpp"

namespace glint::sim {

struct LocalisationSettings {
  double rest_position_m = 0.001;  // per axis, at the pivot
  double rest_angle_rad = 0.002;   // per axis
  double rest_correlation_s = 20;

  double position_per_speed_s = 0.03;          // m of error per m/s
  double position_per_angular_speed_m = 0.01;  // m of error per rad/s
  double angle_per_speed_s_m = 0.02;           // rad of error per m/s
  double angle_per_angular_speed_s = 0.02;     // rad of error per rad/s
  double motion_correlation_s = 0.4;

  Vector3 motion_position_bias = Vector3::Zero();  // added to the random part, same units:
  Vector3 motion_angle_bias = Vector3::Zero();     // 0.1 is a tenth of its standard deviation

  double latency_s = 0;
  // Constant error: pose of the true world in the stated one; empty: none.
  std::optional<Pose> T_stated_world;
  double pivot_m = 0.5;  // ahead of the camera, on its axis
};

// T_world_camera as estimated by the headset, for times from 0 to duration (held constant beyond).
class Localisation {
 public:
  Localisation(const LocalisationSettings& settings, MotionPointer camera, Duration duration,
               std::uint64_t seed);
  [[nodiscard]] Pose pose(Time time) const;

 private:
  struct Error {
    Vector3 position = Vector3::Zero();  // at the pivot, world axes
    Vector3 angle = Vector3::Zero();     // rotation vector, world axes
  };
  [[nodiscard]] Error error(Time time) const;

  LocalisationSettings settings_;
  MotionPointer camera_;
  std::vector<Error> errors_;  // sampled every k_localisation_step
};

inline constexpr Duration k_localisation_step = milliseconds(10);

// External optical tracker such as ART: white noise, its own world frame.
struct ReferenceSettings {
  double position_sigma_m = 0.0002;  // per axis
  double angle_sigma_rad = 0.0005;   // per axis
  Pose T_reference_world;            // pose of the simulated world in the reference's frame
};

// Returns T_reference_tool of one sample; `index` numbers the samples.
[[nodiscard]] Pose reference_pose(const ReferenceSettings& settings, const Pose& T_world_tool,
                                  std::uint64_t seed, int tool, std::uint64_t index);

}  // namespace glint::sim
