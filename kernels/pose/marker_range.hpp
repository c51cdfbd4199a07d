// Range of a marker's centre along its ray, if the marker is one of a tool's.
//
// What:     the measured surface range, plus a sphere's radius. If a depth bias was measured for
//           the tool's kind of marker, it replaces the camera's. A point without an image, e.g. of
//           another tracker, has no peak and no such bias.
// Cost:     two sums; ten operations more for a tool with a bias of its own.
// Worst:    a bias of its own.
// Accuracy: that of depth_bias.hpp.
// Source:   depth_bias.hpp.
#pragma once

#include "kernels/pose/marker.hpp"
#include "kernels/pose/tool.hpp"

namespace glint {

// Metres, radial.
[[nodiscard]] inline double centre_range_m(const Marker& marker, const Tool& tool) noexcept {
  double surface = marker.surface_range_m;
  if (tool.depth_bias.is_measured() && marker.peak > 0) {
    const double raw = surface + static_cast<double>(marker.bias_subtracted_m);
    surface = raw - tool.depth_bias.at(raw, marker.peak);
  }
  return surface + tool.centre_offset_m();
}

}  // namespace glint
