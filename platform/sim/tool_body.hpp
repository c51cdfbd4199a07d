// Model of a hand-held tool: side towards the camera, shaft and hand.
#pragma once

#include "platform/sim/scenario.hpp"

namespace glint::sim {

// Unit vectors in the tool's frame.
struct Grip {
  Vector3 towards_camera = Vector3::UnitX();
  Vector3 up = Vector3::UnitZ();  // from the tip to the markers, perpendicular to towards_camera
  Vector3 centroid = Vector3::Zero();  // centroid of the markers, metres
};

// Returns the direction with the most markers separate from each other and from the shaft, averaged
// over tilts up to 25 degrees.
[[nodiscard]] Grip best_grip(const Tool& tool);

// Returns T_world_tool with the markers' centroid at `place` and the best side towards the camera.
[[nodiscard]] Pose grip_pose(const Grip& grip, const Vector3& place, const Vector3& camera);

// Adds shaft and hand behind and below the markers. The shaft is 15 mm behind the line from the tip
// to the markers' centroid, since markers are on posts. The hand begins 45 mm below the lowest
// marker.
[[nodiscard]] ToolBody held_tool(const Tool& tool, const Grip& grip, const SignalSettings& signal,
                                 MotionPointer motion);

// Expresses the body in a frame rotated by `turn` and translated so that its true tip is at
// stated_m. Ground truth and estimate then refer to the same point and axes.
void align_to_stated_frame(const Vector3& stated_m, const Quaternion& turn, ToolBody& body);

}  // namespace glint::sim
