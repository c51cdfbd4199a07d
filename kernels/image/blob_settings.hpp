// Which blobs may be markers.
#pragma once

#include <array>
#include <cstdint>

#include "kernels/image/pixel_noise.hpp"

namespace glint {

struct SizeGate {
  std::uint32_t min_area_px = 0;
  std::uint32_t max_area_px = 0;
};

inline constexpr int k_depth_bins = 128;

// The areas of a whole marker by its raw depth: what find_blobs compares a blob with where it
// cannot keep all. Without `known` all areas are equally likely.
struct MarkerSizes {
  bool known = false;
  int depth_shift = 0;             // raw depth >> depth_shift is its bin
  std::uint16_t invalid_from = 0;  // raw depth from here on, and 0, is none
  SizeGate without_depth;          // at any range at which tools are expected
  std::array<SizeGate, k_depth_bins> by_depth{};
};

struct BlobSettings {
  std::uint32_t min_area_px = 2;          // smaller ones are noise
  std::uint32_t max_area_px = 4096;       // larger ones are hands and lamps
  std::uint16_t threshold = 0;            // the one that the runs were made with
  std::uint16_t saturated_from = 0xFFFF;  // raw reflectivity at which the sensor clips
  PixelNoise noise{};                     // what a centroid's variance follows from
  MarkerSizes sizes{};                    // what decides which blobs stay if there are too many
};

// The areas that a marker of this radius covers between these ranges (metres, radial) with room for
// partial occlusion and blur: from 0.3 of its disc of radius f r / range_max to 1.5 of its disc of
// radius f r / range_min + 1 px. focal_px: root of the pixels a steradian, the focal length at the
// centre. At least 1 px. Nonsense (radius or range <= 0) gives the widest gate.
[[nodiscard]] SizeGate size_gate(double radius_m, double range_min_m, double range_max_m,
                                 double focal_px) noexcept;

// The markers of a cell, and how its camera measures their range.
struct MarkerOptics {
  double radius_min_m = 0.005, radius_max_m = 0.005;  // smallest and largest marker
  double visible_part_min = 0.8;  // of the disc: of a flat marker less, which a tilt narrows
  double focal_px = 0;            // root of the pixels a steradian
  double range_min_m = 0.15, range_max_m = 1.0;
  double depth_unit_m = 0.001;
  std::uint16_t depth_invalid_from = 0xFFFF;
};

// From visible_part_min of the disc of the smallest marker to size_gate's largest area of the
// largest marker. A depth outside the range limits counts as the nearer limit. Nonsense (a length
// <= 0) returns sizes without `known`.
[[nodiscard]] MarkerSizes marker_sizes(const MarkerOptics& optics) noexcept;

}  // namespace glint
