// Each node of both graphs behind a function of its own, so that the stack under it can be bounded
// by the compiler's call graph and painted at run time.
#pragma once

#include <span>
#include <string_view>

#include "nodes/output.hpp"
#include "nodes/tracker.hpp"

namespace glint::footprint {

template <class G>
struct NodeCall {
  std::string_view name;
  void (*call)(G& graph) noexcept;  // all copies of a split, one after another
};

// In the order of execution.
[[nodiscard]] std::span<const NodeCall<Tracker>> tracker_calls();
[[nodiscard]] std::span<const NodeCall<Output>> output_calls();

// The whole activation in one function, as an executor on one thread has it.
void activate_tracker(Tracker& graph) noexcept;
void activate_output(Output& graph) noexcept;

}  // namespace glint::footprint
