// One function per node of both graphs, so that the compiler's call graph bounds its stack and a
// painted stack measures it.
#pragma once

#include <span>
#include <string_view>

#include "nodes/output.hpp"
#include "nodes/tracker.hpp"

namespace glint::footprint {

template <class G>
struct NodeCall {
  std::string_view name;
  void (*call)(G& graph) noexcept;  // all partitions of a split, one after another
};

// In execution order.
[[nodiscard]] std::span<const NodeCall<Tracker>> tracker_calls();
[[nodiscard]] std::span<const NodeCall<Output>> output_calls();

// The whole activation in one function, as in a single-threaded executor.
void activate_tracker(Tracker& graph) noexcept;
void activate_output(Output& graph) noexcept;

}  // namespace glint::footprint
