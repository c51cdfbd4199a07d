#include "platform/budget/prove/kernel_counts.hpp"

#include "kernels/motion/static_detector.hpp"
#include "kernels/pose/depth_samples.hpp"
#include "kernels/pose/weighted_fit.hpp"
#include "nodes/node_limits.hpp"
#include "nodes/output.hpp"
#include "nodes/tracker.hpp"
#include "schedules/kernel_list.hpp"

namespace glint::prove {
namespace {

template <class Listed>
KernelCounts counts_of_unit(const Limits& limits) {
  using Node = typename graph::Unit<Listed>::Node;
  KernelCounts counts{std::string(graph::type_name<Node>()), {}};
  const graph::LoopCounts worst = Node::worst(limits);
  for (std::size_t loop = 0; loop < Node::k_loops.size(); ++loop) {
    counts.worst[std::string(Node::k_loops[loop])] = worst[loop];
  }
  return counts;
}

template <class... Listed>
std::vector<KernelCounts> counts_of_units(const Limits& limits, graph::TypeList<Listed...>) {
  return {counts_of_unit<Listed>(limits)...};
}

}  // namespace

std::vector<KernelCounts> kernel_counts(const Limits& limits) {
  return counts_of_units(
      limits, graph::Join<typename Tracker::Wires::Listed, typename Output::Wires::Listed>{});
}

NamedCounts names_of(const Limits& limits) {
  return {{"width", limits.width},
          {"height", limits.height},
          {"tools", limits.tools},
          {"markers_per_tool", limits.markers_per_tool},
          {"blobs", limits.blobs},
          {"runs_per_band", limits.runs_per_band},
          {"lens_steps", limits.lens_steps},
          {"ray_steps", limits.ray_steps},
          {"search_steps", limits.search_steps},
          {"reflectivity_bytes", limits.reflectivity_bytes},
          {"centroid_pixels_per_blob", limits.centroid_pixels_per_blob},
          {"range_pixels_per_blob", limits.range_pixels_per_blob},
          {"range_samples_per_blob", limits.range_samples_per_blob},
          {"row_bands", k_row_bands},
          {"tools_per_partition", tools_of(limits, {0, k_tool_partitions})},
          {"static_levels", k_static_window_levels},
          {"fit_steps", k_refine_steps_max},
          {"range_values", k_range_values_max},
          {"square_side", 2 * k_scan_radius_max_px},
          {"labelings", k_labelings_max}};
}

}  // namespace glint::prove
