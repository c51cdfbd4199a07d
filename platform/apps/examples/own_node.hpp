// A node of this project in Glint's tracker: the range of the nearest marker, with a budget.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <glint/nodes/tracker.hpp>
#include <string_view>

namespace own {

struct Nearest {
  double range_m = 0;  // 0: no marker
};

struct FindNearest {
  glint::Limits limits;
  void operator()(const glint::Markers& markers, Nearest& nearest) noexcept {
    nearest.range_m = 0;
    const int count = std::min(markers.count, limits.blobs);
    for (int m = 0; m < count; ++m) {
      const glint::Marker& marker = markers.items[static_cast<std::size_t>(m)];
      if ((marker.flags & glint::k_marker_no_depth) != 0) continue;
      const bool is_nearer = nearest.range_m == 0 || marker.surface_range_m < nearest.range_m;
      if (is_nearer) nearest.range_m = marker.surface_range_m;
    }
    counts_ = {{1, count}};
  }

  // The budget: names of the loops, their maxima under a cell's limits, the last call's counts.
  static constexpr std::array<std::string_view, 2> k_loops = {"call", "markers"};
  [[nodiscard]] static constexpr glint::graph::LoopCounts worst(const glint::Limits& limits) {
    return {{1, limits.blobs}};
  }
  [[nodiscard]] glint::graph::LoopCounts counts() const noexcept { return counts_; }

 private:
  glint::graph::LoopCounts counts_;
};
static_assert(glint::graph::Budgeted<FindNearest, glint::Limits>);

// Glint's tracker with this node beside it.
template <class... Listed>
auto with_nearest(glint::graph::TypeList<Listed...>) -> glint::graph::Graph<
    glint::graph::Inputs<glint::Frame, glint::HeadPose, glint::graph::Latest<glint::ToolSet>>,
    glint::graph::Outputs<glint::Estimates, Nearest>, Listed..., FindNearest>;
using Tracker = decltype(with_nearest(glint::Tracker::Wires::Listed{}));
static_assert(glint::graph::valid<Tracker>);

}  // namespace own
