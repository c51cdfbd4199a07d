// Bounded single-producer single-consumer queue of time-stamped CAN frames, wait-free on both
// sides.
//
// `head` counts pushed frames, `tail` popped ones; each is written by one side only. A slot belongs
// to the consumer exactly while it is between tail and head.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <optional>

#include "kernels/units.hpp"
#include "kernels/wire/can_frame.hpp"

namespace glint {

struct StampedFrame {
  CanFrame frame;
  Time time;
};

class FrameRing {
 public:
  static constexpr std::size_t k_capacity = 16384;  // 13 s of five frames at 250 Hz; power of two

  // Returns false if full.
  [[nodiscard]] bool push(const StampedFrame& item) noexcept {
    const std::uint64_t head = head_.load(std::memory_order_relaxed);
    if (head - tail_.load(std::memory_order_acquire) == k_capacity) return false;
    slots_[head % k_capacity] = item;
    head_.store(head + 1, std::memory_order_release);
    return true;
  }

  // Returns nothing if empty.
  [[nodiscard]] std::optional<StampedFrame> pop() noexcept {
    const std::uint64_t tail = tail_.load(std::memory_order_relaxed);
    if (tail == head_.load(std::memory_order_acquire)) return {};
    const StampedFrame item = slots_[tail % k_capacity];
    tail_.store(tail + 1, std::memory_order_release);
    return item;
  }

  [[nodiscard]] std::uint64_t pushed() const noexcept { return head_.load(); }

 private:
  std::array<StampedFrame, k_capacity> slots_{};
  alignas(64) std::atomic<std::uint64_t> head_{0};
  alignas(64) std::atomic<std::uint64_t> tail_{0};
};

}  // namespace glint
