// What stands behind the pen: a drawn room that the head moves through, or one real frame.
#pragma once

#include <vector>

#include "kernels/geometry.hpp"
#include "platform/sensors/camera.hpp"
#include "platform/sensors/frame_buffer.hpp"

namespace glint::sim {

// Aligned with the world's axes (x ahead, y left, z up). Seen from inside it is a room.
struct Box {
  Vector3 low = Vector3::Zero(), high = Vector3::Zero();  // metres
  double albedo = 0.5;                                    // of SignalSettings::wall
};

struct Room {
  Box walls{{-2, -2.2, -1.3}, {3, 2.2, 1.4}, 0.6};
  std::vector<Box> furniture;
};

// A table below the pen, a cabinet, a screen.
[[nodiscard]] Room furnished_room();

// One frame for all time, in the camera's pixels: reflectivity in counts, radial range in metres, 0
// where there is none. Empty: the room is drawn instead.
struct BackgroundFrame {
  std::vector<float> reflectivity;
  std::vector<float> range_m;
  [[nodiscard]] bool empty() const { return reflectivity.empty(); }
};

// The frame's reflectivity as it stands; its depth by the camera's DepthSettings, never unwrapped.
// Throws InputError if the frame has another size than the camera, or no depth.
[[nodiscard]] BackgroundFrame background_from_frame(const FrameBuffer& frame, const Camera& camera);

}  // namespace glint::sim
