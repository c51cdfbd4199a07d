// Frames that no camera should send, drawn so that the frame group does as much as it ever can: for
// trials of the bound on a board. Each is drawn over a rendered frame's stamps and head pose.
//
// What:     what each drives to its maximum stands at its name.
// Cost:     every pixel is written once.
// Source:   the loops' declared maxima, kernels/limits.hpp.
#pragma once

#include <cstdint>
#include <string_view>

#include "platform/sensors/frame_buffer.hpp"

namespace glint {

enum class WorstFrame : std::uint8_t {
  all_bright,    // one blob of every pixel: rows, pixels of runs
  comb,          // every second column: runs and joins of runs that lie above each other
  dots,          // every second pixel of every second row: runs that each are a blob
  checkerboard,  // runs that touch at their corners only
  markers,       // as many blobs of a marker's size as fit: candidates, rays, hypotheses
  noise,         // every pixel bright or dark by chance: no pattern that a branch could learn
};
inline constexpr int k_worst_frames = 6;

[[nodiscard]] std::string_view name_of(WorstFrame kind);

// `bright` and `dark` are raw reflectivity on either side of the threshold, `depth` raw depth in
// the range where tools are expected. The buffer's size and planes stay as they are.
void draw(WorstFrame kind, std::uint16_t bright, std::uint16_t dark, std::uint16_t depth,
          FrameBuffer& pixels);

}  // namespace glint
