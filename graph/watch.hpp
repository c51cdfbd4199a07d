// Boundary: decides after each node whether the activation continues (deadline monitoring).
//
// A boundary receives the node that has finished and returns whether to continue. Three kinds:
// always; by a deadline and the host's clock; by a recording. False ends the activation: the
// remaining nodes do not run, and the feedback of the nodes so far is undone.
// Cost: NoBoundary none; DeadlineWatch one reading of the clock per node.
#pragma once

#include <concepts>
#include <cstdint>
#include <span>

#include "graph/overrun.hpp"

namespace glint::graph {

// The executor calls go_on(node) when a node has finished, and again while worker 0 waits for
// another worker's part; node is then the last one that worker 0 ran.
template <class T>
concept Boundary = requires(T& boundary, int node) {
  { boundary.go_on(node) } -> std::same_as<bool>;
};

struct NoBoundary {
  static constexpr bool go_on(int /*node*/) noexcept { return true; }
};

// Nanoseconds since the activation's nominal release; may lag, never decreases.
template <class T>
concept ActivationClock = requires(T& clock) {
  { clock.elapsed_ns() } -> std::same_as<std::int64_t>;
};

// The deadline is relative to the nominal release, so that it includes the release jitter.
template <ActivationClock Clock>
class DeadlineWatch {
 public:
  // `remaining_ns`, by node: worst case from that node's end to the group's end. If empty, only a
  // deadline that has passed is detected. The span's data must outlive this object.
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
  // {} while the activation continues.
  [[nodiscard]] const OverrunDecision& decision() const noexcept { return decision_; }

 private:
  Clock* clock_;
  std::int64_t deadline_ns_;
  std::span<const std::int64_t> remaining_ns_;
  OverrunPolicy policy_;
  OverrunDecision decision_;
};

// Ends the activation at the recorded node; needs no clock.
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
