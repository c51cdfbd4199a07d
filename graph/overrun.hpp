// What is done about an activation that takes, or will take, longer than its chain may wait.
//
// An overrun is noticed at a node's boundary: after node k either the deadline has passed, or what
// the remaining nodes may need at worst (their bounds) no longer fits before it (`will_miss`). The
// remaining nodes are then not run, and the chain's declared policy says what leaves instead. The
// decision is data: recorded, it makes a replay do the same without a clock.
#pragma once

#include <cstdint>
#include <string_view>

namespace glint::graph {

enum class OverrunPolicy : std::uint8_t {
  skip_output = 0,  // nothing leaves for this activation
  hold_last = 1,    // what left last leaves again, no longer called measured
  predict = 2,      // the last known motion is extrapolated
  stop_safe = 3,    // everything is declared lost until the next activation that is in time
};

[[nodiscard]] constexpr std::string_view name_of(OverrunPolicy policy) {
  constexpr std::string_view names[] = {"skip_output", "hold_last", "predict", "stop_safe"};
  return names[static_cast<std::uint8_t>(policy) & 3];
}

enum class OverrunKind : std::uint8_t { none = 0, will_miss = 1, missed = 2 };

// One activation's decision. In a recording it stands as two bytes, and {} means that there was
// none.
struct OverrunDecision {
  OverrunKind kind = OverrunKind::none;
  OverrunPolicy policy = OverrunPolicy::skip_output;
  std::uint8_t after_node = 0;  // the last node that ran, in the graph's order of execution

  [[nodiscard]] constexpr bool happened() const { return kind != OverrunKind::none; }
  bool operator==(const OverrunDecision&) const = default;
};

}  // namespace glint::graph
