// Frames for all tests of this folder: a crowd of sixteen tools with strays, and patterns that
// drive the image loops to their maxima.
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/pose/head_pose.hpp"
#include "platform/cells/cell.hpp"
#include "platform/formats/frame_buffer.hpp"

namespace glint::footprint {

struct PlayedFrame {
  FrameBuffer pixels;
  HeadPose head;
};

struct TestFrames {
  Cell cell;  // sixteen tools, AHAT
  std::vector<PlayedFrame> crowd;
  std::vector<PlayedFrame> worst;
};

// Rendered at the first call.
[[nodiscard]] const TestFrames& test_frames();

// Frame of cycle `i`: the crowd forwards and backwards, with a worst-case frame at intervals.
[[nodiscard]] const PlayedFrame& frame_of_cycle(std::uint32_t cycle);

}  // namespace glint::footprint
