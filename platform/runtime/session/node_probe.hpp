// Probe around each node of a watched activation: records a trace and injects delays.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>

#include "kernels/units.hpp"
#include "platform/runtime/rt/node_trace.hpp"

namespace glint {

// Time since an activation's nominal release. Live, the CPU's cycle counter measures it. In runs
// that are not in real time, only injected delays advance it.
class ElapsedClock {
 public:
  explicit ElapsedClock(bool live) noexcept
      : live_(live), ns_per_cycle_(live ? ns_per_cycle() : 0) {}

  // `already`: time since the nominal release at the CPU's count `cycles`.
  void begin(Duration already, std::uint64_t cycles) noexcept {
    begin_ns_ = live_ ? already.nanoseconds : 0;
    begin_cycles_ = cycles;
  }
  [[nodiscard]] std::int64_t elapsed_ns() const noexcept {
    if (!live_) return begin_ns_;
    const auto cycles = static_cast<std::int64_t>(cycle_count() - begin_cycles_);
    return begin_ns_ + static_cast<std::int64_t>(static_cast<double>(cycles) * ns_per_cycle_);
  }
  // Live: busy-waits for that time. Otherwise: advances the clock by it.
  void delay(Duration time) noexcept {
    if (!live_) {
      begin_ns_ += time.nanoseconds;
      return;
    }
    const std::int64_t until_ns = elapsed_ns() + time.nanoseconds;
    while (elapsed_ns() < until_ns) {
    }
  }

 private:
  bool live_;
  double ns_per_cycle_;
  std::int64_t begin_ns_ = 0;
  std::uint64_t begin_cycles_ = 0;
};

// A delay at the end of one node of one activation, once.
struct Injection {
  std::string node;      // as given: "FindBlobs" or "RoiThreshold#1"
  int number = 0;        // in the graph's order of execution
  bool in_tick = false;  // in the tick group; else in the frame group
  std::uint64_t at = 0;  // the frame's sequence number, or the tick's
  Duration delay;
  bool done = false;
};

// Parses "node=FindBlobs,delay_us=200,frame=512" or, for the tick group,
// "node=PackCan,delay_us=200,tick=40"; "RoiThreshold#i" is copy i of a split node. Throws
// InputError.
[[nodiscard]] Injection injection_of(const std::string& text);

// One per worker.
class NodeProbe {
 public:
  NodeProbe(ElapsedClock& clock, std::span<Injection> injections, NodeTrace* trace) noexcept
      : clock_(&clock), injections_(injections), trace_(trace) {}

  void begin(std::uint64_t at) noexcept { at_ = at; }
  void on_node_begin(int node) noexcept {
    if (trace_ != nullptr) trace_->on_node_begin(node);
  }
  void on_node_end(int node) noexcept {
    bool injected = false;
    for (Injection& injection : injections_) {
      if (injection.number != node || injection.at != at_ || injection.done) continue;
      injection.done = injected = true;  // exactly one worker runs this node
      clock_->delay(injection.delay);
    }
    if (trace_ == nullptr) return;
    trace_->on_node_end(node);
    if (injected) trace_->set_flag(k_span_injected);
  }
  [[nodiscard]] NodeTrace* trace() noexcept { return trace_; }

 private:
  ElapsedClock* clock_;
  std::span<Injection> injections_;
  NodeTrace* trace_;
  std::uint64_t at_ = 0;
};

}  // namespace glint
