// How a person holds a tool: which side faces the camera, where its shaft and the hand are.
#pragma once

#include "platform/sim/scenario.hpp"

namespace glint::sim {

// Unit vectors in the tool's frame.
struct Grip {
  Vector3 towards_camera = Vector3::UnitX();
  Vector3 up = Vector3::UnitZ();     // from the tip to the markers, square to towards_camera
  Vector3 middle = Vector3::Zero();  // of the markers, metres
};

// The side from which the most markers stand clear of each other and of the shaft, on average over
// 25 degrees round.
[[nodiscard]] Grip best_grip(const Tool& tool);

// T_world_tool that puts the markers' middle at `place`, the best side towards the camera.
[[nodiscard]] Pose held_at(const Grip& grip, const Vector3& place, const Vector3& camera);

// With shaft and hand behind and below the markers. The shaft runs 15 mm behind the line from the
// tip to the markers' middle, for markers stand on posts; the hand begins 45 mm below the lowest.
[[nodiscard]] ToolBody held_tool(const Tool& tool, const Grip& grip, const SignalSettings& signal,
                                 MotionPointer motion);

// The same body in a frame that is turned, and shifted so that its tip, as made, lies where it is
// stated: truth and estimate are then of the same point and of the same axes.
void put_tip_at(const Vector3& stated_m, const Quaternion& turn, ToolBody& body);

}  // namespace glint::sim
