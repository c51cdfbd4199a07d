// Scenario of touches of two points and a static phase: the recording that `glint verify` requires.
//
// The tip of the first tool is on one of two points for hold_s. The tilt of the tool and the
// position of the head change with each touch; every third touch is on the second point. At the end
// the tool is held on the first point for rest_s. Tremor rotates the tool about its tip; the head
// sways slightly.
#pragma once

#include "platform/sim/scenario.hpp"

namespace glint::sim {

struct TouchSettings {
  Vector3 first_m{0.42, -0.08, -0.33};  // world
  Vector3 second_m{0.48, 0.10, -0.27};
  int touches = 18;
  double hold_s = 2.8, move_s = 1.2, rest_s = 22;
  double lean_rad = 0.45;                                    // maximum
  double view_aside_rad = 0.6, view_up_rad[2] = {0.2, 0.7};  // of the head, from the tool
  double view_m[2] = {0.34, 0.70};                           // its distance from the markers
  double sway_rms_m = 0.005, gaze_rms_rad = 0.01;

  [[nodiscard]] double distance_m() const { return (second_m - first_m).norm(); }
  [[nodiscard]] Duration duration() const;
};

// Replaces the motion of the head and of the first tool, and the duration; keeps other events. The
// same random seed gives the same motion.
void touch_points(const TouchSettings& settings, std::uint64_t seed, Scenario& scenario);

}  // namespace glint::sim
