// The frames that every test of this folder plays: a crowd of sixteen tools with strays, and
// patterns that drive the image's loops to their maxima.
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/pose/head_pose.hpp"
#include "platform/cells/cell.hpp"
#include "platform/sensors/frame_buffer.hpp"

namespace glint::footprint {

struct PlayedFrame {
  FrameBuffer pixels;
  HeadPose head;
};

struct Play {
  Cell cell;  // sixteen tools, AHAT
  std::vector<PlayedFrame> crowd;
  std::vector<PlayedFrame> worst;
};

// Rendered at the first call.
[[nodiscard]] const Play& play();

// Which frame cycle `i` shows: the crowd to and fro, and now and then a worst one.
[[nodiscard]] const PlayedFrame& shown_in(std::uint32_t cycle);

}  // namespace glint::footprint
