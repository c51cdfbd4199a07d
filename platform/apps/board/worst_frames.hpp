// Worst-case input frames that drive the frame group's loops to their maxima, to test the time
// bound on a companion computer. Each replaces the pixels of a rendered frame; time stamps and head
// pose remain.
//
// What:     each enumerator states the loops that it drives to the maximum.
// Cost:     writes every pixel once.
// Source:   the loops' declared maxima, kernels/limits.hpp.
#pragma once

#include <cstdint>
#include <string_view>

#include "platform/formats/frame_buffer.hpp"

namespace glint {

enum class WorstFrame : std::uint8_t {
  all_bright,    // one blob of every pixel: rows, pixels of runs
  comb,          // every second column: runs and merges of vertically adjacent runs
  dots,          // every second pixel of every second row: each run is a blob
  checkerboard,  // runs that touch only at their corners
  markers,       // maximum number of marker-sized blobs: candidates, rays, hypotheses
  noise,         // random pixels: no pattern for branch prediction
};
inline constexpr int k_worst_frames = 6;

[[nodiscard]] std::string_view name_of(WorstFrame kind);

// `bright` and `dark`: raw reflectivity on either side of the threshold; `depth`: raw depth in the
// range of the tools. Size and planes of the buffer remain.
void draw(WorstFrame kind, std::uint16_t bright, std::uint16_t dark, std::uint16_t depth,
          FrameBuffer& pixels);

}  // namespace glint
