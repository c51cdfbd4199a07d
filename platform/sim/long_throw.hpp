// Depth pictures of a simulated headset's mapping camera, with a robot in them that the tracking
// camera's frames do not show.
//
// What:     the scenario's room, pen, hands, and a robot's triangles, as depth along the axis of
//           a pinhole of 80 x 72 pixels that looks as the tracking camera does, with noise.
// Accuracy: the room's as the simulator draws it, the robot's to float's rounding.
// Source:   HoloLens 2's long-throw mode, every fourth pixel of its 320 x 288 on each side; focal
//           length and noise are declared here.
#pragma once

#include <vector>

#include "platform/robot/robot_model.hpp"
#include "platform/sim/lens_rays.hpp"
#include "platform/sim/room_drawer.hpp"
#include "platform/sim/simulator.hpp"

namespace glint {

// 77 degrees from side to side.
inline constexpr Pinhole k_long_throw{80, 72, 50, 50, 40, 36};
inline constexpr double k_long_throw_sigma_m = 0.002;

class LongThrow {
 public:
  // The robot's triangles stand in its base's frame. The simulator outlives this.
  LongThrow(const sim::Simulator& simulator, PosedSurface robot, const Pose& T_world_robot);

  // Of the simulator's frame `i`, at its true mid-exposure: metres, row by row. `frame` becomes
  // that frame's description; its head pose is where the headset takes itself to be.
  [[nodiscard]] std::vector<float> depth(int i, sim::SimFrame& frame);

 private:
  void draw_room(const sim::SimFrame& frame, sim::Planes& planes) const;

  const sim::Simulator& simulator_;
  PosedSurface robot_;
  Pose T_world_robot_;
  sim::LensRays rays_;
  sim::RoomDrawer room_;
};

}  // namespace glint
