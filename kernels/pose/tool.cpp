#include "kernels/pose/tool.hpp"

#include <span>

#include "kernels/pose/rigid_fit.hpp"

namespace glint {

Reason prepare_tool(Tool& tool) noexcept {
  for (auto& row : tool.distance_m) row.fill(0);
  if (tool.marker_count > k_markers_per_tool_max) return Reason::out_of_range;
  if (tool.marker_count < 3) return Reason::too_few_markers;
  const auto count = static_cast<std::size_t>(tool.marker_count);
  const Reason spread = rotation_is_fixed_by(std::span(tool.markers_m.data(), count));
  if (spread != Reason::none) return spread;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = i + 1; j < count; ++j) {
      const double distance = (tool.markers_m[i] - tool.markers_m[j]).norm();
      if (distance < k_marker_distance_min_m) return Reason::degenerate;
      tool.distance_m[i][j] = distance;
      tool.distance_m[j][i] = distance;
    }
  }
  return Reason::none;
}

}  // namespace glint
