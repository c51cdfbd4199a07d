// Background of the scene: a synthetic room, or one real frame.
#pragma once

#include <vector>

#include "kernels/geometry.hpp"
#include "platform/formats/camera.hpp"
#include "platform/formats/frame_buffer.hpp"

namespace glint::sim {

// Box aligned with the world's axes (x ahead, y left, z up). From inside it is a room.
struct Box {
  Vector3 low = Vector3::Zero(), high = Vector3::Zero();  // metres
  double albedo = 0.5;                                    // relative to SignalSettings::wall
};

struct Room {
  Box walls{{-2, -2.2, -1.3}, {3, 2.2, 1.4}, 0.6};
  std::vector<Box> furniture;
};

// Returns a room with a table below the pen, a cabinet and a screen.
[[nodiscard]] Room furnished_room();

// One frame for all times, in the camera's pixels: reflectivity in counts, radial range in metres,
// 0 without range. Empty: the room is rendered instead.
struct BackgroundFrame {
  std::vector<float> reflectivity;
  std::vector<float> range_m;
  [[nodiscard]] bool empty() const { return reflectivity.empty(); }
};

// Keeps the frame's reflectivity; converts its depth by the camera's DepthSettings, without
// unwrapping. Throws InputError if the frame's size differs from the camera's, or without depth.
[[nodiscard]] BackgroundFrame background_from_frame(const FrameBuffer& frame, const Camera& camera);

}  // namespace glint::sim
