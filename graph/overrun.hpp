// Overrun handling: policy and decision for an activation that misses, or will miss, its deadline.
//
// An overrun is detected at a node's boundary: after node k the deadline has passed (`missed`), or
// the worst case of the remaining nodes (their bounds) no longer fits before it (`will_miss`). The
// remaining nodes then do not run, and the chain's declared policy determines the output. The
// decision is data: a recording of it lets a replay reproduce the activation without a clock.
#pragma once

#include <cstdint>
#include <string_view>

namespace glint::graph {

enum class OverrunPolicy : std::uint8_t {
  skip_output = 0,  // no output for this activation
  hold_last = 1,    // the previous output again, no longer marked as measured
  predict = 2,      // the last motion estimate is extrapolated
  stop_safe = 3,    // every tool is declared lost until the next activation in time
};

[[nodiscard]] constexpr std::string_view name_of(OverrunPolicy policy) {
  constexpr std::string_view names[] = {"skip_output", "hold_last", "predict", "stop_safe"};
  return names[static_cast<std::uint8_t>(policy) & 3];
}

enum class OverrunKind : std::uint8_t {
  none = 0,
  will_miss = 1,
  missed = 2,
  not_enabled = 3,  // no overrun: a person has not enabled the output since a crash
};

// Decision for one activation. A recording stores it as two bytes; {} means no overrun.
struct OverrunDecision {
  OverrunKind kind = OverrunKind::none;
  OverrunPolicy policy = OverrunPolicy::skip_output;
  std::uint8_t after_node = 0;  // the last node that ran, in execution order

  [[nodiscard]] constexpr bool happened() const { return kind != OverrunKind::none; }
  bool operator==(const OverrunDecision&) const = default;
};

}  // namespace glint::graph
