// Visibility of markers from ground truth alone: the rule behind the count of `trackable` frames.
//
// A marker is visible if
//   - at least k_visible_fraction_min of its disc (its silhouette) is unobstructed; a pixel whose
//   ray the
//     lens does not map counts as obstructed,
//   - its disc is inside the image,
//   - its range is within the camera's range_min_m..range_max_m,
//   - it is isolated: no other disc that sends light into the image is within k_gap_px of its own,
//     where two discs may merge into one blob.
// Brightness has no influence, since the threshold belongs to the tracker.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "platform/formats/camera.hpp"
#include "platform/sim/scene.hpp"

namespace glint::sim {

inline constexpr double k_visible_fraction_min = 0.80;
inline constexpr double k_gap_px = 2.0;

using RenderedReflectors = std::array<RenderedReflector, k_reflectors_max>;  // in the scene's order

void find_visible(const Camera& camera, const Scene& scene, const RenderedReflectors& drawn,
                  std::vector<std::uint8_t>& masks);  // one per tool; sized by the caller

}  // namespace glint::sim
