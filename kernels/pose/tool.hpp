// Tool: a rigid body of markers, as described in a tool file.
#pragma once

#include <array>
#include <cstdint>

#include "kernels/geometry.hpp"
#include "kernels/limits.hpp"
#include "kernels/pose/depth_bias.hpp"
#include "kernels/reason.hpp"

namespace glint {

enum class MarkerShape : std::uint8_t { sphere, disc };

struct Tool {
  std::array<Vector3, k_markers_per_tool_max> markers_m;  // tool frame
  std::array<std::array<double, k_markers_per_tool_max>, k_markers_per_tool_max> distance_m{};
  int marker_count = 0;
  double marker_radius_m = 0;
  MarkerShape shape = MarkerShape::sphere;
  DepthBias depth_bias;             // of its markers, replaces the camera's if measured
  Vector3 tip_m = Vector3::Zero();  // tool frame
  std::array<char, 32> name{};      // zero-terminated
  // Hash of all fields above but the name, set by prepare_tool(). It reveals that the tool in a
  // slot of the set was exchanged. 0: not prepared.
  std::uint32_t identity = 0;
  // Standard deviation of a marker's position in the tool, per axis; the default is for a tool not
  // measured by `glint calibrate tool`.
  double marker_sigma_m = 0.0003;
  // Standard deviation of the tip relative to the markers, per axis; the default is for a tip not
  // found by `glint calibrate pivot`.
  double tip_sigma_m = 0.0003;

  // False for an empty slot of the set.
  [[nodiscard]] bool present() const { return marker_count > 0; }

  // Mean of its markers, tool frame.
  [[nodiscard]] Vector3 middle_m() const {
    Vector3 sum = Vector3::Zero();
    for (int i = 0; i < marker_count; ++i) sum += markers_m[static_cast<std::size_t>(i)];
    return sum / (marker_count > 0 ? marker_count : 1);
  }

  // Distance of a marker's centre behind the visible surface, along the ray.
  [[nodiscard]] double centre_offset_m() const {
    return shape == MarkerShape::sphere ? marker_radius_m : 0.0;
  }
};

// Tools in use. A slot keeps its index while the set changes, because the CAN frames' numbers
// depend on it.
struct ToolSet {
  std::array<Tool, k_tools_max> items;
  int count = 0;
};

// Minimum distance of two markers: no marker is smaller, so closer ones are one marker.
inline constexpr double k_marker_distance_min_m = 0.001;

// Computes distance_m from markers_m, and the identity. Reason: too_few_markers (< 3), out_of_range
// (more than k_markers_per_tool_max, or a coordinate that is not finite), degenerate (two markers
// at one position) or collinear. Such a tool must not be used.
[[nodiscard]] Reason prepare_tool(Tool& tool) noexcept;

}  // namespace glint
