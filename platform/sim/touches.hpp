// Touches of two points and a rest: the recording that `glint verify` needs, simulated.
//
// The tip of the first tool stands on one of two points for hold_s, the tool leans to another side
// and the head looks from another place each time; every third touch is on the second point. At the
// end the tool is held on the first point for rest_s. Tremor turns the tool about its tip; the head
// sways a little.
#pragma once

#include "platform/sim/scenario.hpp"

namespace glint::sim {

struct TouchSettings {
  Vector3 first_m{0.42, -0.08, -0.33};  // world
  Vector3 second_m{0.48, 0.10, -0.27};
  int touches = 18;
  double hold_s = 2.8, move_s = 1.2, rest_s = 22;
  double lean_rad = 0.45;                                    // at most
  double view_aside_rad = 0.6, view_up_rad[2] = {0.2, 0.7};  // of the head, as seen from the tool
  double view_m[2] = {0.34, 0.70};                           // its distance from the markers
  double sway_rms_m = 0.005, gaze_rms_rad = 0.01;

  [[nodiscard]] double distance_m() const { return (second_m - first_m).norm(); }
  [[nodiscard]] Duration duration() const;
};

// Replaces the motion of head and first tool, and the duration; other events stay. Same random
// seed, same motion.
void touch_points(const TouchSettings& settings, std::uint64_t seed, Scenario& scenario);

}  // namespace glint::sim
