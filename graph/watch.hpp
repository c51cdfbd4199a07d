// What an executor asks after each node: whether the activation goes on.
//
// A boundary is told which node has ended and answers. Three of them: always on; by a deadline and
// a clock that the host hands in; as a recording decided. An answer of false ends the activation:
// the remaining nodes are not run, and what the nodes so far have fed back is taken back.
// Cost: NoBoundary none; DeadlineWatch one look at the clock a node.
#pragma once

#include <concepts>
#include <cstdint>
#include <span>

#include "graph/overrun.hpp"

namespace glint::graph {

// go_on(node) is called when a node has ended, and again while worker 0 waits for a part that
// another worker still computes: node is the last one that worker 0 ran.
template <class T>
concept Boundary = requires(T& boundary, int node) {
  { boundary.go_on(node) } -> std::same_as<bool>;
};

struct NoBoundary {
  static constexpr bool go_on(int /*node*/) noexcept { return true; }
};

// Nanoseconds since the activation's nominal release; may lag behind, never goes backwards.
template <class T>
concept ActivationClock = requires(T& clock) {
  { clock.elapsed_ns() } -> std::same_as<std::int64_t>;
};

// The deadline counts from the nominal release, so that a late wake-up counts, too.
template <ActivationClock Clock>
class DeadlineWatch {
 public:
  // `remaining_ns`, by node: what may be needed at worst from that node's end to the group's end;
  // empty: there is no bound, and only a deadline that has passed is noticed. It outlives this.
  DeadlineWatch(Clock& clock, std::int64_t deadline_ns, std::span<const std::int64_t> remaining_ns,
                OverrunPolicy policy) noexcept
      : clock_(&clock), deadline_ns_(deadline_ns), remaining_ns_(remaining_ns), policy_(policy) {}

  [[nodiscard]] bool go_on(int node) noexcept {
    const std::int64_t elapsed_ns = clock_->elapsed_ns();
    const auto i = static_cast<std::size_t>(node);
    const std::int64_t needed_ns = i < remaining_ns_.size() ? remaining_ns_[i] : 0;
    if (elapsed_ns > deadline_ns_) {
      decision_.kind = OverrunKind::missed;
    } else if (elapsed_ns + needed_ns > deadline_ns_) {
      decision_.kind = OverrunKind::will_miss;
    } else {
      return true;
    }
    decision_.policy = policy_;
    decision_.after_node = static_cast<std::uint8_t>(node);
    return false;
  }
  // {} while the activation goes on.
  [[nodiscard]] const OverrunDecision& decision() const noexcept { return decision_; }

 private:
  Clock* clock_;
  std::int64_t deadline_ns_;
  std::span<const std::int64_t> remaining_ns_;
  OverrunPolicy policy_;
  OverrunDecision decision_;
};

// Ends where a recording says that it ended; without a clock.
class RecordedBoundary {
 public:
  explicit RecordedBoundary(const OverrunDecision& decision) noexcept
      : last_(decision.happened() ? decision.after_node : k_never) {}
  [[nodiscard]] bool go_on(int node) const noexcept { return node < last_; }

 private:
  static constexpr int k_never = 256;  // beyond any node
  int last_;
};

}  // namespace glint::graph
