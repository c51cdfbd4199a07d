// Bounded single-producer single-consumer queue (ring buffer): wait-free on both sides, static
// storage.
//
// A full queue drops the new item and counts it: a slow consumer (disk, network) never blocks the
// producer. Cost: one atomic load, one store and a copy of T on either side.
// Source: Lamport 1983, "Specifying concurrent program modules", the bounded buffer of two
//         counters; tests/unit/graph/ring_model_test.cpp checks every interleaving.
#pragma once

#include <atomic>
#include <cstdint>

#include "graph/port.hpp"

namespace glint::graph {

// Numbers of items pushed and popped since the start, modulo 2^32. Each function is at most one
// atomic step, so that a model test can run all interleavings of this code with its own atomic
// type.
template <int N, class Atomic = std::atomic<std::uint32_t>>
class RingIndex {
  static_assert(N >= 1 && (N & (N - 1)) == 0, "the counters wrap: N is a power of two");

 public:
  explicit constexpr RingIndex(std::uint32_t start = 0) noexcept
      : push_count_(start), pushed_(start), pop_count_(start), popped_(start) {}

  // Producer: tests for a free slot, returns its index, and passes the filled slot to the consumer.
  [[nodiscard]] bool has_room() const noexcept {
    return push_count_ - popped_.load(std::memory_order_acquire) < N;
  }
  [[nodiscard]] int push_slot() const noexcept { return static_cast<int>(push_count_ % N); }
  void push() noexcept { pushed_.store(++push_count_, std::memory_order_release); }

  // Consumer: tests for an item, returns its slot, and releases the slot.
  [[nodiscard]] bool has_item() const noexcept {
    return pushed_.load(std::memory_order_acquire) != pop_count_;
  }
  [[nodiscard]] int pop_slot() const noexcept { return static_cast<int>(pop_count_ % N); }
  void pop() noexcept { popped_.store(++pop_count_, std::memory_order_release); }

 private:
  alignas(k_cache_line) std::uint32_t push_count_;  // the producer's own copy of pushed_
  Atomic pushed_;
  alignas(k_cache_line) std::uint32_t pop_count_;  // the consumer's own copy of popped_
  Atomic popped_;
};

template <class T, int N>
class Ring {
 public:
  // Producer: if the ring is full, returns false and increments dropped().
  bool push(const T& item) noexcept {
    if (!index_.has_room()) {
      dropped_.store(dropped_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
      return false;
    }
    slots_[index_.push_slot()] = item;
    index_.push();
    return true;
  }
  // Consumer: returns the oldest item; false, with `item` unchanged, if the ring is empty.
  bool pop(T& item) noexcept {
    if (!index_.has_item()) return false;
    item = slots_[index_.pop_slot()];
    index_.pop();
    return true;
  }
  // Items dropped since the start; callable from any thread.
  [[nodiscard]] std::uint64_t dropped() const noexcept {
    return dropped_.load(std::memory_order_relaxed);
  }
  [[nodiscard]] static constexpr int capacity() noexcept { return N; }

 private:
  RingIndex<N> index_;
  std::atomic<std::uint64_t> dropped_{0};
  T slots_[N]{};
};

}  // namespace glint::graph
