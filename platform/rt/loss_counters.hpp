// What a run has lost so far, by kind, for whoever reports it from another thread.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace glint {

// The values stand in CAN emergency frames.
enum class LossKind : std::uint8_t {
  can = 0,        // frames that the bus or the log did not take
  dds = 1,        // messages that the ring or DDS did not take
  recording = 2,  // messages that the recording lacks
  files = 3,      // lines that the trajectory files lack
};
inline constexpr std::size_t k_loss_kinds = 4;

[[nodiscard]] constexpr std::string_view name_of(LossKind kind) {
  constexpr std::array<std::string_view, k_loss_kinds> names{"CAN", "DDS", "recording", "files"};
  return names[static_cast<std::size_t>(kind)];
}

struct LossCounters {
  std::array<std::atomic<std::uint64_t>, k_loss_kinds> lost{};

  void store(LossKind kind, std::uint64_t count) noexcept {
    lost[static_cast<std::size_t>(kind)].store(count, std::memory_order_relaxed);
  }
  [[nodiscard]] std::uint64_t of(LossKind kind) const noexcept {
    return lost[static_cast<std::size_t>(kind)].load(std::memory_order_relaxed);
  }
};

}  // namespace glint
