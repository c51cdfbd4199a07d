// Synthetic motion of a hand that alternates between rest and strokes, and of a swaying head.
//
// Source: a hand holding still has 0.05 mm rms at about 8 Hz, and 99 % of voluntary power is below
// 2 Hz.
#pragma once

#include <cstdint>

#include "platform/sim/motion.hpp"

namespace glint::sim {

struct HandSettings {
  Pose T_world_tool;                 // at rest
  Vector3 grip_m = Vector3::Zero();  // tool frame; strokes move it, rotations are about it
  double begin_s = 0;                // at rest before
  double cycle_s = 12;               // a rest, then strokes
  double rest_fraction = 0.2;        // of the cycle; 1: always at rest
  double stroke_rms_m = 0.035;       // per axis
  double rotation_rms_rad = 0.16;    // per axis
  double slowest_hz = 0.15, fastest_hz = 1.8;
  double tremor_rms_m = 0.00005;  // per axis
  double tremor_rms_rad = 0.0005;
  double tremor_hz = 8;
};

struct HeadSettings {
  Vector3 position_m = Vector3::Zero();  // world: x ahead, y left, z up
  Vector3 target_m = Vector3::UnitX();   // world; the head looks at it
  double begin_s = 0;
  double sway_rms_m = 0.02;    // per axis
  double gaze_rms_rad = 0.04;  // about each of the camera's axes
  double slowest_hz = 0.05, fastest_hz = 0.6;
};

[[nodiscard]] MotionPointer hand_motion(const HandSettings& settings, std::uint64_t seed,
                                        std::uint64_t instance);
[[nodiscard]] MotionPointer head_motion(const HeadSettings& settings, std::uint64_t seed);

// Returns the pose of a camera at `position` that looks at `target`, x axis level (world z is up).
[[nodiscard]] Pose look_at(const Vector3& position, const Vector3& target);

}  // namespace glint::sim
