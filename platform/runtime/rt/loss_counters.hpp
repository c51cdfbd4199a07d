// Counters of lost output by kind, published to reporting threads.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace glint {

// The values are used in CAN emergency frames.
enum class LossKind : std::uint8_t {
  can = 0,        // frames not accepted by the bus or the log
  dds = 1,        // messages not accepted by the ring or DDS
  recording = 2,  // messages missing in the recording
  files = 3,      // lines missing in the trajectory files
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
