// Publishes the set of present tools to the frame group, a new version at each change.
//
// A version encodes its set. A recording stores the version of each frame and therefore replays
// every change without storing the sets.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

#include "graph/latest.hpp"
#include "platform/cells/cell.hpp"
#include "platform/cells/tool_changes.hpp"

namespace glint {

// Version of the n-th published set, n from 1, with these tools present.
[[nodiscard]] constexpr std::uint64_t tools_version(std::uint64_t number, ToolsPresent there) {
  return number << 16 | there;
}
// Recordings from before tools could change have version 1: all tools are present.
[[nodiscard]] constexpr ToolsPresent tools_in(std::uint64_t version) {
  return version >> 16 == 0 ? k_all_tools : static_cast<ToolsPresent>(version & 0xFFFF);
}

// Requests from outside a run to add or remove tools: written by one thread, applied by another.
class ToolRequests {
 public:
  // Thread-safe. The last request for a tool counts.
  void ask(int tool, bool there) noexcept {
    const std::uint32_t bit = 1u << tool;
    std::uint32_t before = requested_.load(std::memory_order_relaxed), after = 0;
    do {
      const std::uint32_t wanted = there ? before | bit : before & ~bit;
      after = wanted | bit << k_mask_shift;
    } while (!requested_.compare_exchange_weak(before, after, std::memory_order_relaxed));
  }

  // Applies the requests since the last call to the present tools.
  [[nodiscard]] ToolsPresent applied_to(ToolsPresent there) noexcept {
    const std::uint32_t requested = requested_.exchange(0, std::memory_order_relaxed);
    const auto about = static_cast<ToolsPresent>(requested >> k_mask_shift);
    const auto wanted = static_cast<ToolsPresent>(requested);
    return static_cast<ToolsPresent>((there & ~about) | (wanted & about));
  }

 private:
  static constexpr int k_mask_shift = k_tools_max;
  static_assert(2 * k_tools_max <= 32);
  std::atomic<std::uint32_t> requested_{0};  // low bits: wanted; high bits: tools concerned
};

class ToolRoster {
 public:
  // Both must outlive this object; `requests` may be null.
  explicit ToolRoster(const Cell& cell, ToolRequests* requests = nullptr)
      : cell_(&cell),
        requests_(requests),
        planned_(cell.tools_at_start),
        there_(cell.tools_at_start) {
    publish(there_, Time{});
  }

  [[nodiscard]] graph::TripleBuffer<ToolSet>& published() noexcept { return published_; }

  // Applies the cell's changes up to `now` and the requests; publishes the set if it differs. Call
  // from one thread, not real-time; the delay of a change is the time until the next call. A change
  // of the cell affects only the tools that it names.
  void apply_changes(Time now) {
    ToolsPresent there = there_;
    for (; next_ < cell_->tool_changes.size() && cell_->tool_changes[next_].at <= now; ++next_) {
      const ToolsPresent planned = cell_->tool_changes[next_].present;
      const auto named = static_cast<ToolsPresent>(planned ^ planned_);
      there = static_cast<ToolsPresent>((there & ~named) | (planned & named));
      planned_ = planned;
    }
    if (requests_ != nullptr) there = requests_->applied_to(there);
    if (there == there_) return;
    there_ = there;
    publish(there, now);
  }

 private:
  void publish(ToolsPresent there, Time now) {
    published_.write_slot() = tools_present(cell_->tools, there);
    published_.publish(tools_version(++number_, there), now.nanoseconds);
  }

  const Cell* cell_;
  graph::TripleBuffer<ToolSet> published_;
  ToolRequests* requests_;
  std::uint64_t number_ = 0;
  std::size_t next_ = 0;
  ToolsPresent planned_, there_;
};

}  // namespace glint
