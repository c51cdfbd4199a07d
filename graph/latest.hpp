// A value that crosses a rate boundary: the newest version, wait-free on both sides.
//
// One writer, one reader. Three slots: the writer owns one, the reader owns one, the third waits in
// between; publishing and sampling swap slots by one atomic exchange. Neither side ever waits for
// the other, also not when one preempts the other on a single core.
// Cost: publish one exchange; sample one load and at most one exchange. (arm64 before version 8.1
// builds an exchange from a retry loop, which one preemption can make turn once more.)
// Source: the triple buffer of computer graphics; every interleaving is tried in
// tests/unit/graph/latest_model_test.cpp.
#pragma once

#include <atomic>
#include <cstdint>

#include "graph/port.hpp"

namespace glint::graph {

// Which slot belongs to whom. Each function is at most one atomic step, so that a model can try all
// interleavings of this very code with an atomic of its own.
template <class Atomic = std::atomic<std::uint32_t>>
class TripleIndex {
 public:
  [[nodiscard]] int writer_slot() const noexcept { return static_cast<int>(writer_); }
  [[nodiscard]] int reader_slot() const noexcept { return static_cast<int>(reader_); }

  // Writer: gives its slot away as the newest and gets a free one.
  void publish() noexcept {
    writer_ = waiting_.exchange(writer_ | k_fresh, std::memory_order_acq_rel) & k_slot_mask;
  }
  // Reader: whether something newer waits. Relaxed, because only take() looks into a slot.
  [[nodiscard]] bool fresh() const noexcept {
    return (waiting_.load(std::memory_order_relaxed) & k_fresh) != 0;
  }
  // Reader: gives its slot back for the newest. Only after fresh() said so, else it goes backwards.
  void take() noexcept {
    reader_ = waiting_.exchange(reader_, std::memory_order_acq_rel) & k_slot_mask;
  }

 private:
  static constexpr std::uint32_t k_slot_mask = 3;
  static constexpr std::uint32_t k_fresh = 4;
  alignas(k_cache_line) std::uint32_t writer_ = 0;
  alignas(k_cache_line) Atomic waiting_{1};
  alignas(k_cache_line) std::uint32_t reader_ = 2;
};

template <class T>
class TripleBuffer {
 public:
  // Writer: the slot to fill, whole, before publish(). It holds some older version.
  [[nodiscard]] T& write_slot() noexcept { return slots_[index_.writer_slot()].value; }
  // Writer: versions count from 1 and rise; 0 means "never written".
  void publish(std::uint64_t version, std::int64_t time_ns) noexcept {
    Slot& slot = slots_[index_.writer_slot()];
    slot.version = version;
    slot.time_ns = time_ns;
    index_.publish();
  }

  // Reader: moves on to the newest version; false if there is none newer than the one it holds.
  bool sample() noexcept {
    if (!index_.fresh()) return false;
    index_.take();
    return true;
  }
  // Reader: what the last sample() found; T{}, version 0 before anything was published.
  [[nodiscard]] const T& value() const noexcept { return slots_[index_.reader_slot()].value; }
  [[nodiscard]] std::uint64_t version() const noexcept {
    return slots_[index_.reader_slot()].version;
  }
  [[nodiscard]] std::int64_t time_ns() const noexcept {
    return slots_[index_.reader_slot()].time_ns;
  }

 private:
  struct alignas(k_cache_line) Slot {
    T value{};
    std::uint64_t version = 0;
    std::int64_t time_ns = 0;
  };
  TripleIndex<> index_;
  Slot slots_[3]{};
};

// A node's view of a value from another rate group. It belongs to the reading graph and changes
// only in sample() or set(), so that all nodes of an activation see one version.
template <class T>
class Latest {
 public:
  // Reads from a buffer from now on; the buffer outlives this and has no other reader.
  void bind(TripleBuffer<T>& buffer) noexcept { buffer_ = &buffer; }
  // Hands in a value without a buffer: a constant, a test's value, one from a recording.
  void set(const T& value, std::uint64_t version, std::int64_t time_ns) noexcept {
    buffer_ = nullptr;
    held_ = value;
    version_ = version;
    time_ns_ = time_ns;
  }
  bool sample() noexcept { return buffer_ != nullptr && buffer_->sample(); }

  [[nodiscard]] const T& value() const noexcept { return buffer_ ? buffer_->value() : held_; }
  [[nodiscard]] std::uint64_t version() const noexcept {
    return buffer_ ? buffer_->version() : version_;
  }
  [[nodiscard]] std::int64_t time_ns() const noexcept {
    return buffer_ ? buffer_->time_ns() : time_ns_;
  }

 private:
  TripleBuffer<T>* buffer_ = nullptr;
  T held_{};
  std::uint64_t version_ = 0;
  std::int64_t time_ns_ = 0;
};

}  // namespace glint::graph
