// Settings of blob detection: size gate, expected marker areas by depth, pixel noise.
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

// Expected area of an isolated marker by raw depth. find_blobs ranks blobs by it if it cannot keep
// all. If `known` is false, all areas are equally likely.
struct MarkerSizes {
  bool known = false;
  int depth_shift = 0;             // raw depth >> depth_shift is its bin
  std::uint16_t invalid_from = 0;  // raw depth from here on, and 0, is invalid
  SizeGate without_depth;          // at any range at which tools are expected
  std::array<SizeGate, k_depth_bins> by_depth{};
};

struct BlobSettings {
  std::uint32_t min_area_px = 2;          // smaller ones are noise
  std::uint32_t max_area_px = 4096;       // larger ones are hands and lamps
  std::uint16_t threshold = 0;            // threshold of the runs
  std::uint16_t saturated_from = 0xFFFF;  // raw reflectivity at which the sensor clips
  PixelNoise noise{};                     // for the centroid's variance
  MarkerSizes sizes{};                    // for the selection if there are too many blobs
};

// Areas that a marker of this radius covers between these ranges (metres, radial), with margins for
// partial occlusion and blur: from 0.3 of its disc of radius f r / range_max to 1.5 of its disc of
// radius f r / range_min + 1 px. focal_px: square root of the pixels per steradian, the focal
// length at the centre. At least 1 px. Invalid input (radius or range <= 0) returns the widest
// gate.
[[nodiscard]] SizeGate size_gate(double radius_m, double range_min_m, double range_max_m,
                                 double focal_px) noexcept;

// The markers of a cell, and the optics and range measurement of its camera.
struct MarkerOptics {
  double radius_min_m = 0.005, radius_max_m = 0.005;  // smallest and largest marker
  double visible_part_min = 0.8;  // of the disc; less for a flat marker, which a tilt narrows
  double focal_px = 0;            // square root of the pixels per steradian
  double range_min_m = 0.15, range_max_m = 1.0;
  double depth_unit_m = 0.001;
  std::uint16_t depth_invalid_from = 0xFFFF;
};

// Areas from visible_part_min of the disc of the smallest marker to size_gate's largest area of the
// largest marker. A depth outside the range limits is clamped to them. Invalid input (a length
// <= 0) returns sizes with `known` false.
[[nodiscard]] MarkerSizes marker_sizes(const MarkerOptics& optics) noexcept;

}  // namespace glint
