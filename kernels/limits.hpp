// Capacities of Glint: the largest problem that it accepts. Each is a constant of the code. Every
// loop maximum, every buffer size and the computed worst case follow from these alone, not from
// measurements.
#pragma once

namespace glint {

inline constexpr int k_width_max = 1024;  // Azure Kinect, wide: 1024 x 1024
inline constexpr int k_height_max = 1024;
inline constexpr int k_tools_max = 16;
inline constexpr int k_markers_per_tool_max = 8;
inline constexpr int k_blobs_max = 256;
inline constexpr int k_row_bands = 4;  // partitions of the frame; independent of the worker count
inline constexpr int k_runs_per_band_max = 4096;
inline constexpr int k_reflectivity_bytes_max = 2;  // per pixel
// Budgets that all blobs share, stated per blob. Most blobs need less; a large blob may use what
// the others leave (shared_budget.hpp).
inline constexpr int k_centroid_pixels_per_blob = 360;  // of the box of a blob 11 pixels wide
inline constexpr int k_range_pixels_per_blob = 128;     // pixels read for depth
inline constexpr int k_range_samples_per_blob = 16;     // ranges averaged
inline constexpr int k_labelings_max = 8;               // kept per tool, best first
inline constexpr int k_lens_steps_max = 40;       // of a search in a lens table, per projection
inline constexpr int k_ray_steps_max = 20;        // of the ray iteration through a lens
inline constexpr int k_search_steps_max = 4'096;  // of the correspondence search, per tool
inline constexpr int k_background_steps_max = 50'000;  // per background slice (slice_size.hpp)

// Capacities of one cell: at most the constants above. Nodes stop at these limits, and the
// worst-case execution time of a chain is computed from them; a smaller cell has a smaller bound.
struct Limits {
  int width = k_width_max;
  int height = k_height_max;
  int tools = k_tools_max;
  int markers_per_tool = k_markers_per_tool_max;
  int blobs = k_blobs_max;
  int runs_per_band = k_runs_per_band_max;
  int lens_steps = k_lens_steps_max;  // 0 for a lens without a table
  int ray_steps = k_ray_steps_max;    // of the cell's lens: ray_steps_needed()
  int search_steps = k_search_steps_max;
  int background_steps = k_background_steps_max;
  int tracking_steps = k_background_steps_max;  // per slice of robot tracking; 0: no robot
  int reflectivity_bytes = k_reflectivity_bytes_max;
  int centroid_pixels_per_blob = k_centroid_pixels_per_blob;
  int range_pixels_per_blob = k_range_pixels_per_blob;
  int range_samples_per_blob = k_range_samples_per_blob;
  int covariance_frames = 0;  // on CAN, a tick: one a tool where the cell sends them
};

}  // namespace glint
