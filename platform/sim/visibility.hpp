// Which markers a perfect observer would call visible: the truth that tracked fractions divide by.
//
// A marker is visible if
//   - its whole silhouette lies inside the frame and the lens, and at least k_open_share_min of it
//     is not hidden by shaft, hand or other things,
//   - its range is within the camera's range_min_m..range_max_m,
//   - its brightest pixel is above the camera's threshold,
//   - no other reflector's silhouette comes within k_gap_px of its own: two would make one blob.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "platform/sensors/camera.hpp"
#include "platform/sim/scene.hpp"

namespace glint::sim {

inline constexpr double k_open_share_min = 0.95;
inline constexpr double k_gap_px = 2.0;

using DrawnReflectors = std::array<Drawn, k_reflectors_max>;  // in the scene's order

void find_visible(const Camera& camera, const Scene& scene, const DrawnReflectors& drawn,
                  std::vector<std::uint8_t>& masks);  // one a tool; sized by the caller

}  // namespace glint::sim
