// What a frame truly showed, where a source has it beside its frames.
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/geometry.hpp"
#include "kernels/units.hpp"

namespace glint {

struct FrameTruth {
  Time mid_exposure;  // the true one; the stamp may differ
  Pose T_world_camera;
  std::vector<Pose> T_world_tool;
  std::vector<std::uint8_t> visible_mask;  // each tool; bit i: its marker i is truly visible
};

}  // namespace glint
