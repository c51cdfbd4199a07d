// Which blobs may be markers.
#pragma once

#include <cstdint>

#include "kernels/image/pixel_noise.hpp"

namespace glint {

struct BlobSettings {
  std::uint32_t min_area_px = 2;          // smaller ones are noise
  std::uint32_t max_area_px = 4096;       // larger ones are hands and lamps
  std::uint16_t threshold = 0;            // the one that the runs were made with
  std::uint16_t saturated_from = 0xFFFF;  // raw reflectivity at which the sensor clips
  PixelNoise noise{};                     // what a centroid's variance follows from
};

struct SizeGate {
  std::uint32_t min_area_px = 0;
  std::uint32_t max_area_px = 0;
};

// The areas that a marker of this radius covers between these ranges (metres, radial) with room for
// partial occlusion and blur: from 0.3 of its disc of radius f r / range_max to 1.5 of its disc of
// radius f r / range_min + 1 px. focal_px: root of the pixels a steradian, the focal length at the
// centre. At least 1 px. Nonsense (radius or range <= 0) gives the widest gate.
[[nodiscard]] SizeGate size_gate(double radius_m, double range_min_m, double range_max_m,
                                 double focal_px) noexcept;

}  // namespace glint
