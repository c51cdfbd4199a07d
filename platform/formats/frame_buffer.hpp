// Owner of the pixels that a Frame references.
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/image/frame.hpp"

namespace glint {

struct FrameBuffer {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> reflectivity_8;  // one of the two is empty
  std::vector<std::uint16_t> reflectivity_16;
  std::vector<std::uint16_t> depth;  // may be empty

  [[nodiscard]] Frame view(Time mid_exposure, Time arrival, std::uint64_t sequence) const {
    Frame frame;
    frame.mid_exposure = mid_exposure;
    frame.arrival = arrival;
    frame.sequence = sequence;
    if (!reflectivity_8.empty()) frame.reflectivity_8 = {reflectivity_8.data(), width, height};
    if (!reflectivity_16.empty()) frame.reflectivity_16 = {reflectivity_16.data(), width, height};
    if (!depth.empty()) frame.depth = {depth.data(), width, height};
    return frame;
  }
};

}  // namespace glint
