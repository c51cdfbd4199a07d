// A rigid body of markers, as a tool file describes it.
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
  DepthBias depth_bias;             // of its markers, in place of the camera's; not measured: that
  Vector3 tip_m = Vector3::Zero();  // tool frame
  std::array<char, 32> name{};      // zero-terminated
  // Of its body, so that a slot of the set whose tool is exchanged is seen to be: from all fields
  // above but the name, by prepare_tool(). 0: not prepared.
  std::uint32_t identity = 0;
  // Standard deviation of a marker's position in the tool, an axis: of a tool that was not measured
  // by `glint calibrate tool`.
  double marker_sigma_m = 0.0003;
  // Of the tip among the markers, an axis: of one that `glint calibrate pivot` did not find.
  double tip_sigma_m = 0.0003;

  // A slot of the set may be empty.
  [[nodiscard]] bool present() const { return marker_count > 0; }

  // The mean of its markers, in the tool's frame.
  [[nodiscard]] Vector3 middle_m() const {
    Vector3 sum = Vector3::Zero();
    for (int i = 0; i < marker_count; ++i) sum += markers_m[static_cast<std::size_t>(i)];
    return sum / (marker_count > 0 ? marker_count : 1);
  }

  // How far behind the surface that the camera sees the marker's centre lies, along the ray.
  [[nodiscard]] double centre_offset_m() const {
    return shape == MarkerShape::sphere ? marker_radius_m : 0.0;
  }
};

// The tools in use. A slot keeps its number while the set changes, for it numbers CAN frames.
struct ToolSet {
  std::array<Tool, k_tools_max> items;
  int count = 0;
};

// Two markers nearer to each other than this are one: no marker is that small.
inline constexpr double k_marker_distance_min_m = 0.001;

// Fills distance_m from markers_m, and the identity. Reason: too_few_markers (< 3), out_of_range
// (more than k_markers_per_tool_max, or a coordinate that is not finite), degenerate (two markers
// in one place) or collinear. Such a tool must not be used.
[[nodiscard]] Reason prepare_tool(Tool& tool) noexcept;

}  // namespace glint
