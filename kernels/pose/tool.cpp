#include "kernels/pose/tool.hpp"

#include <bit>
#include <span>

#include "kernels/pose/rigid_fit.hpp"

namespace glint {
namespace {

// FNV-1a hash of the numbers' bits, byte by byte (Fowler, Noll and Vo 1991).
class BodyHash {
 public:
  void add(std::uint64_t bits) {
    for (int byte = 0; byte < 8; ++byte) {
      value_ = (value_ ^ ((bits >> (8 * byte)) & 0xFF)) * 16777619u;
    }
  }
  void add(double number) { add(std::bit_cast<std::uint64_t>(number)); }
  void add(const Vector3& v) {
    for (int axis = 0; axis < 3; ++axis) add(v(axis));
  }
  [[nodiscard]] std::uint32_t value() const { return value_ != 0 ? value_ : 1; }

 private:
  std::uint32_t value_ = 2166136261u;
};

std::uint32_t identity_of(const Tool& tool) {
  BodyHash hash;
  hash.add(static_cast<std::uint64_t>(tool.marker_count));
  for (int i = 0; i < tool.marker_count; ++i) hash.add(tool.markers_m[static_cast<std::size_t>(i)]);
  hash.add(tool.marker_radius_m);
  hash.add(static_cast<std::uint64_t>(tool.shape));
  hash.add(tool.tip_m);
  if (const DepthBias& bias = tool.depth_bias; bias.is_measured()) {
    for (const double part :
         {bias.offset_m, bias.per_metre, bias.low_signal_m, bias.range_min_m, bias.range_max_m})
      hash.add(part);
  }
  return hash.value();
}

}  // namespace

Reason prepare_tool(Tool& tool) noexcept {
  for (auto& row : tool.distance_m) row.fill(0);
  tool.identity = 0;
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
  tool.identity = identity_of(tool);
  return Reason::none;
}

}  // namespace glint
