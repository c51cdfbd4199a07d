// Execution trace of a node: two reads of the CPU cycle counter and one entry in a ring.
//
// One object per worker of a group, because each ring has one producer. A node's span is pushed
// when the worker continues, so that flags set after the node are still stored in it.
#pragma once

#include <cstdint>
#include <span>

#include "graph/ring.hpp"
#include "platform/runtime/rt/cycle_clock.hpp"
#include "platform/runtime/rt/trace_span.hpp"

namespace glint {

// 8192 spans are 400 ticks and 9 frames of one worker, far more than gather between two writes.
using SpanRing = graph::Ring<TraceSpan, 8192>;

class NodeTrace {
 public:
  // `bounds_ns` per node, or empty; it and the ring must outlive this object.
  NodeTrace(SpanRing& ring, std::uint8_t group, std::uint8_t worker,
            std::span<const std::int64_t> bounds_ns = {}) noexcept
      : ring_(&ring), bounds_ns_(bounds_ns), ns_per_cycle_(ns_per_cycle()) {
    span_.group = group;
    span_.worker = worker;
  }

  // `now_ns` on the session's clock, read at cycle count `cycles`.
  void begin_activation(std::uint64_t activation, std::uint64_t frame_sequence, std::int64_t now_ns,
                        std::uint64_t cycles) noexcept {
    span_.activation = activation;
    span_.frame_sequence = static_cast<std::uint32_t>(frame_sequence);
    anchor_ns_ = now_ns;
    anchor_cycles_ = cycles;
  }
  void on_node_begin(int /*node*/) noexcept {
    flush();
    begin_cycles_ = cycle_count();
  }
  void on_node_end(int node) noexcept {
    const std::uint64_t end_cycles = cycle_count();
    const auto i = static_cast<std::size_t>(node);
    span_.begin_ns = at(begin_cycles_);
    span_.end_ns = at(end_cycles);
    span_.node = static_cast<std::uint8_t>(node);
    span_.flags = 0;
    span_.bound_ns = i < bounds_ns_.size() ? bounds_ns_[i] : 0;
    span_pending_ = true;
  }
  // Sets a flag on the span of the node that ended last.
  void set_flag(TraceFlag flag) noexcept {
    span_.flags = static_cast<std::uint8_t>(span_.flags | flag);
  }
  // Adds a span that is not a node: a release, or the CAN writes.
  void add(TraceFlag kind, std::int64_t begin_ns, std::int64_t end_ns) noexcept {
    flush();
    TraceSpan span = span_;
    span.node = 0;
    span.flags = kind;
    span.bound_ns = 0;
    span.begin_ns = begin_ns;
    span.end_ns = end_ns;
    (void)ring_->push(span);
  }
  void end_activation() noexcept { flush(); }

 private:
  void flush() noexcept {
    if (!span_pending_) return;
    (void)ring_->push(span_);
    span_pending_ = false;
  }
  [[nodiscard]] std::int64_t at(std::uint64_t cycles) const noexcept {
    return anchor_ns_ + static_cast<std::int64_t>(static_cast<double>(static_cast<std::int64_t>(
                                                      cycles - anchor_cycles_)) *
                                                  ns_per_cycle_);
  }

  SpanRing* ring_;
  std::span<const std::int64_t> bounds_ns_;
  double ns_per_cycle_;
  TraceSpan span_;
  std::int64_t anchor_ns_ = 0;
  std::uint64_t anchor_cycles_ = 0;
  std::uint64_t begin_cycles_ = 0;
  bool span_pending_ = false;
};

}  // namespace glint
