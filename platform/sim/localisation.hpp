// The headset's own localisation, with declared errors, and the tracker that judges it.
//
// The error is a small motion about a pivot ahead of the camera: a visual localisation holds on to
// the scene it sees, so that turning and shifting errors make up for each other there.
//   at rest:   a random walk that returns (Ornstein and Uhlenbeck 1930), the drift of the inertial
//              unit that the seen scene keeps in bounds;
//   in motion: another, faster one, in units of the speed: it grows with linear and angular speed
//              (smoothed over correlation_s), and so has heavier tails than a normal distribution;
//   latency:   the pose given for time t is that of t - latency.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "platform/sim/motion.hpp"

namespace glint::sim {

struct LocalisationSettings {
  double rest_position_m = 0.001;  // each axis, at the pivot
  double rest_angle_rad = 0.002;   // each axis
  double rest_correlation_s = 20;

  double position_per_speed_s = 0.03;  // m of error per m/s
  double position_per_turn_m = 0.01;   // m of error per rad/s
  double angle_per_speed_s_m = 0.02;   // rad of error per m/s
  double angle_per_turn_s = 0.02;      // rad of error per rad/s
  double motion_correlation_s = 0.4;

  Vector3 motion_position_bias = Vector3::Zero();  // added to the random part, same units: 0.1 is
  Vector3 motion_angle_bias = Vector3::Zero();     // a tenth of its standard deviation

  double latency_s = 0;
  // An error that stays: the headset's world in the one that it states; nothing: none.
  std::optional<Pose> T_stated_world;
  double pivot_m = 0.5;  // ahead of the camera, on its axis
};

// T_world_camera as the headset believes it, at any time from 0 to duration (held beyond).
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
  std::vector<Error> errors_;  // on a grid of k_localisation_step
};

inline constexpr Duration k_localisation_step = milliseconds(10);

// An outside-in tracker like ART: white noise, its own world.
struct ReferenceSettings {
  double position_sigma_m = 0.0002;  // each axis
  double angle_sigma_rad = 0.0005;   // each axis
  Pose T_reference_world;            // its axes against the simulated world's
};

// T_reference_tool of one sample; `index` numbers the samples.
[[nodiscard]] Pose reference_pose(const ReferenceSettings& settings, const Pose& T_world_tool,
                                  std::uint64_t seed, int tool, std::uint64_t index);

}  // namespace glint::sim
