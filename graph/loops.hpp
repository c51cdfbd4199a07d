// Loop counts of a node per activation: maxima under given limits, and actual counts. Input of the
// worst-case execution time.
//
// A worst case is a sum of counts times costs. The counts are the code's: a node declares its
// loops, returns their maxima under given limits, and after an activation their actual counts. The
// costs are measured on a companion computer and are not part of this folder.
//
//   struct FindBlobs {
//     static constexpr std::array<std::string_view, 3> k_loops = {"call", "runs", "pixels"};
//     [[nodiscard]] static constexpr LoopCounts worst(const Limits& limits) noexcept;
//     [[nodiscard]] LoopCounts counts() const noexcept;  // of the last activation
//   };
//
// A node under Split whose copies differ may add worst(limits, partition); worst(limits) covers
// all.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace glint::graph {

inline constexpr std::size_t k_loops_max = 8;

// In the order of the node's k_loops; entries beyond them are zero. The first is always "call": 1.
struct LoopCounts {
  std::array<std::int64_t, k_loops_max> n{};

  [[nodiscard]] constexpr std::int64_t operator[](std::size_t loop) const { return n[loop]; }
  constexpr std::int64_t& operator[](std::size_t loop) { return n[loop]; }
  bool operator==(const LoopCounts&) const = default;
};

// True if no count exceeds its maximum.
[[nodiscard]] constexpr bool within(const LoopCounts& counts, const LoopCounts& worst) {
  for (std::size_t loop = 0; loop < k_loops_max; ++loop) {
    if (counts[loop] > worst[loop]) return false;
  }
  return true;
}

// A node with a computable worst case; under Split that of one copy.
template <class Node, class Limits>
concept Budgeted = requires(const Node& node, const Limits& limits) {
  requires Node::k_loops.size() >= 1 && Node::k_loops.size() <= k_loops_max;
  { Node::worst(limits) } -> std::same_as<LoopCounts>;
  { node.counts() } -> std::same_as<LoopCounts>;
};

// Index of a node's loop by its name; with another name the program does not compile.
template <class Node>
[[nodiscard]] consteval std::size_t loop_of(std::string_view name) {
  for (std::size_t loop = 0; loop < Node::k_loops.size(); ++loop) {
    if (Node::k_loops[loop] == name) return loop;
  }
  __builtin_unreachable();  // no constant expression: the node declares no loop of this name
}

}  // namespace glint::graph
