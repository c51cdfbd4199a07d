// Cost of a timed and of a traced node: two readings of the processor's counter, and a span in a
// ring buffer.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#if defined(__x86_64__)
#include <x86intrin.h>
#endif

#include "platform/runtime/rt/trace_span.hpp"

namespace glint::bench {

[[nodiscard]] inline std::uint64_t counter() noexcept {
#if defined(__x86_64__)
  return __rdtsc();
#elif defined(__aarch64__)
  std::uint64_t ticks;
  asm volatile("mrs %0, cntvct_el0" : "=r"(ticks));
  return ticks;
#endif
}

// Longest execution time of each node, for overrun detection.
class TimeOnly {
 public:
  void on_node_begin(int /*node*/) noexcept { begin_ = counter(); }
  void on_node_end(int node) noexcept {
    const std::uint64_t took = counter() - begin_;
    std::uint64_t& longest = longest_[static_cast<std::size_t>(node)];
    if (took > longest) longest = took;
  }

 private:
  std::uint64_t begin_ = 0;
  std::array<std::uint64_t, 64> longest_{};
};

// The same, and every span in a ring buffer.
class TimeAndTrace {
 public:
  void on_node_begin(int /*node*/) noexcept { begin_ = counter(); }
  void on_node_end(int node) noexcept {
    TraceSpan& span = ring_[at_++ & (k_spans - 1)];
    span.begin_ns = static_cast<std::int64_t>(begin_);
    span.end_ns = static_cast<std::int64_t>(counter());
    span.node = static_cast<std::uint8_t>(node);
  }

 private:
  static constexpr std::size_t k_spans = 4096;  // 160 KB: more than the first-level cache
  std::uint64_t begin_ = 0;
  std::size_t at_ = 0;
  std::vector<TraceSpan> ring_ = std::vector<TraceSpan>(k_spans);
};

}  // namespace glint::bench
