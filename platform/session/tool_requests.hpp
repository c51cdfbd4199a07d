// Which tools somebody outside a run wants to be there: asked from one thread, taken up by another.
#pragma once

#include <atomic>
#include <cstdint>

#include "platform/cells/tool_changes.hpp"

namespace glint {

class ToolRequests {
 public:
  // From any thread. Of several about one tool the last counts.
  void ask(int tool, bool there) noexcept {
    const std::uint32_t bit = 1u << tool;
    std::uint32_t before = asked_.load(std::memory_order_relaxed), after = 0;
    do {
      const std::uint32_t wanted = there ? before | bit : before & ~bit;
      after = wanted | bit << k_about;
    } while (!asked_.compare_exchange_weak(before, after, std::memory_order_relaxed));
  }

  // What is there now, after what was asked since the last call.
  [[nodiscard]] ToolsPresent applied_to(ToolsPresent there) noexcept {
    const std::uint32_t asked = asked_.exchange(0, std::memory_order_relaxed);
    const auto about = static_cast<ToolsPresent>(asked >> k_about);
    const auto wanted = static_cast<ToolsPresent>(asked);
    return static_cast<ToolsPresent>((there & ~about) | (wanted & about));
  }

 private:
  static constexpr int k_about = k_tools_max;
  static_assert(2 * k_tools_max <= 32);
  std::atomic<std::uint32_t> asked_{0};  // below: wanted; above: which it is about
};

}  // namespace glint
