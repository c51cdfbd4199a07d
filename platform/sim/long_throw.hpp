// Depth images of a simulated headset's mapping camera, with a robot that the tracking camera's
// frames do not contain.
//
// What:     renders the scenario's room, pen, hands, and a robot's triangles as depth along the
//           axis of a pinhole camera of 80 x 72 pixels, with noise. The camera has the pose of the
//           tracking camera.
// Accuracy: the room's is that of the simulator; the robot's is limited by float rounding.
// Source:   HoloLens 2's long-throw mode, every fourth pixel of its 320 x 288 in both directions;
//           focal length and noise are declared here.
#pragma once

#include <vector>

#include "platform/sim/lens_rays.hpp"
#include "platform/sim/room_drawer.hpp"
#include "platform/sim/simulator.hpp"
#include "platform/tools/robot/robot_model.hpp"

namespace glint {

// Horizontal field of view 77 degrees.
inline constexpr Pinhole k_long_throw{80, 72, 50, 50, 40, 36};
inline constexpr double k_long_throw_sigma_m = 0.002;

class MappingCamera {
 public:
  // Triangles of the robot are in its base frame. The simulator must outlive this object.
  MappingCamera(const sim::Simulator& simulator, PosedSurface robot, const Pose& T_world_robot);

  // Returns the depth of the simulator's frame `i` at its true mid-exposure: metres, row by row.
  // `frame` receives the description of that frame, with the head pose estimated by the headset.
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
