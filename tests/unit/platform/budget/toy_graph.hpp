// Chain of two nodes with budgets and a board file: small enough to calculate by hand.
#pragma once

#include "graph/graph.hpp"
#include "graph/loops.hpp"
#include "kernels/limits.hpp"

namespace glint::toy {

struct Picture {};
struct Spots {};
struct Answer {};

struct FindSpots {
  static constexpr std::array<std::string_view, 2> k_loops = {"call", "pixels"};
  [[nodiscard]] static constexpr graph::LoopCounts worst(const Limits& limits) noexcept {
    return {{1, static_cast<std::int64_t>(limits.width) * limits.height}};
  }
  [[nodiscard]] graph::LoopCounts counts() const noexcept { return {{1, 0}}; }
  void operator()(const Picture&, Spots&) noexcept {}
};

struct FitSpots {
  static constexpr std::array<std::string_view, 3> k_loops = {"call", "tools", "blobs"};
  [[nodiscard]] static constexpr graph::LoopCounts worst(const Limits& limits) noexcept {
    return {{1, limits.tools, limits.blobs}};
  }
  [[nodiscard]] graph::LoopCounts counts() const noexcept { return {{1, 0, 0}}; }
  void operator()(const Spots&, Answer&) noexcept {}
};

using Chain = graph::Graph<graph::Inputs<Picture>, graph::Outputs<Answer>, FindSpots, FitSpots>;

}  // namespace glint::toy
