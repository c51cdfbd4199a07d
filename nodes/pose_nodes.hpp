// Nodes for marker correspondence and assignment to tools. Partition i of n takes the tools with
// index modulo n = i, so that the split is a constant of the graph.
#pragma once

#include <array>
#include <string_view>

#include "graph/graph.hpp"
#include "kernels/nonblocking.hpp"
#include "kernels/pose/assign.hpp"
#include "kernels/pose/correspond.hpp"
#include "kernels/pose/marker.hpp"
#include "kernels/pose/tool.hpp"
#include "nodes/node_limits.hpp"
#include "nodes/tokens.hpp"

namespace glint {

// Candidate labelings of each tool of this partition. Search steps that a tool does not use are
// available to the next tools of the partition.
struct Correspond {
  static constexpr std::array<std::string_view, 8> k_loops = {
      "call",       "tools",         "markers", "pairs",
      "pair_tests", "words_written", "steps",   "words_narrowed"};
  [[nodiscard]] static constexpr graph::LoopCounts worst(const Limits& limits) noexcept {
    return worst(limits, {0, k_tool_partitions});
  }
  [[nodiscard]] static constexpr graph::LoopCounts worst(const Limits& limits,
                                                         graph::Partition partition) noexcept {
    const std::int64_t tools = tools_of(limits, partition);
    const std::int64_t blobs = limits.blobs;
    const std::int64_t pairs = blobs * (blobs - 1) / 2;
    const std::int64_t distances = limits.markers_per_tool * (limits.markers_per_tool - 1) / 2;
    const std::int64_t words = (blobs + 63) / 64;  // of a set of candidates
    return {{1, tools, tools * blobs, tools * pairs, tools * pairs * distances,
             tools * distances * blobs * words, tools * limits.search_steps,
             tools * limits.search_steps * limits.markers_per_tool * words}};
  }
  [[nodiscard]] graph::LoopCounts counts() const noexcept { return counts_; }

  CorrespondSettings settings;
  Limits limits;
  void operator()(const FrameVerdict& verdict, const Markers& markers,
                  const graph::Latest<ToolSet>& tools, const Predictions& predictions,
                  graph::Partition partition, ToolLabelings& labelings) noexcept GLINT_NONBLOCKING;

 private:
  CorrespondScratch scratch_;
  graph::LoopCounts counts_;
};

static_assert(graph::Budgeted<Correspond, Limits>);

// Assigns each marker to at most one tool, in a fixed order.
struct AssignMarkers {
  static constexpr std::array<std::string_view, 4> k_loops = {"call", "tools", "rounds", "tests"};
  // Each round assigns the markers of one tool (assign.hpp counts the tests).
  [[nodiscard]] static constexpr graph::LoopCounts worst(const Limits& limits) noexcept {
    return {{1, limits.tools, limits.tools, assign_tests_worst(limits.tools)}};
  }
  [[nodiscard]] graph::LoopCounts counts() const noexcept { return counts_; }

  Limits limits;
  void operator()(const FrameVerdict& verdict, const graph::Latest<ToolSet>& tools,
                  const graph::Parts<ToolLabelings, k_tool_partitions>& labelings,
                  Assignment& assignment) noexcept GLINT_NONBLOCKING;

 private:
  std::array<Labelings, k_tools_max> per_tool_;  // the partitions' results, by tool
  std::array<int, k_tools_max> chosen_{};
  MarkerOwners owners_{};
  graph::LoopCounts counts_;
};

static_assert(graph::Budgeted<AssignMarkers, Limits>);

}  // namespace glint
