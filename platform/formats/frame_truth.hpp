// Ground truth of a frame, if its source provides it.
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/geometry.hpp"
#include "kernels/units.hpp"

namespace glint {

struct FrameGroundTruth {
  Time mid_exposure;  // the true time; the stamp may differ
  Pose T_world_camera;
  std::vector<Pose> T_world_tool;
  std::vector<std::uint8_t> visible_mask;  // per tool; bit i: its marker i is visible
};

}  // namespace glint
