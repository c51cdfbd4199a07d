// Triple buffer: passes the newest version of a value across a rate boundary, wait-free on both
// sides.
//
// One writer, one reader. Of three slots the writer owns one, the reader owns one, and the third is
// in between; publishing and sampling swap slots by one atomic exchange. Neither side waits for the
// other, even if one preempts the other on a single core.
// Cost:   publish one exchange; sample one load and at most one exchange. (arm64 before version 8.1
//         implements an exchange as a retry loop; one preemption can cause one more iteration.)
// Source: the triple buffer of computer graphics; tests/unit/graph/latest_model_test.cpp checks
//         every interleaving.
#pragma once

#include <atomic>
#include <cstdint>

#include "graph/port.hpp"

namespace glint::graph {

// Slot ownership of a triple buffer. Each function is at most one atomic step, so that a model test
// can run all interleavings of this code with its own atomic type.
template <class Atomic = std::atomic<std::uint32_t>>
class TripleIndex {
 public:
  [[nodiscard]] int writer_slot() const noexcept { return static_cast<int>(writer_); }
  [[nodiscard]] int reader_slot() const noexcept { return static_cast<int>(reader_); }

  // Writer: exchanges its slot, now the newest, for a free one.
  void publish() noexcept {
    writer_ = waiting_.exchange(writer_ | k_fresh, std::memory_order_acq_rel) & k_slot_mask;
  }
  // Reader: true if a newer version is available. Relaxed, because only take() gives access to a
  // slot.
  [[nodiscard]] bool fresh() const noexcept {
    return (waiting_.load(std::memory_order_relaxed) & k_fresh) != 0;
  }
  // Reader: exchanges its slot for the newest. Requires fresh(); otherwise the reader receives an
  // older version.
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
  // Writer: the slot to fill completely before publish(). It contains an older version.
  [[nodiscard]] T& write_slot() noexcept { return slots_[index_.writer_slot()].value; }
  // Writer: publishes the slot. Versions start at 1 and increase; 0 means "never written".
  void publish(std::uint64_t version, std::int64_t time_ns) noexcept {
    Slot& slot = slots_[index_.writer_slot()];
    slot.version = version;
    slot.time_ns = time_ns;
    index_.publish();
  }

  // Reader: moves to the newest version; returns false if there is no newer one.
  bool sample() noexcept {
    if (!index_.fresh()) return false;
    index_.take();
    return true;
  }
  // Reader: the version of the last sample(); T{} with version 0 before the first publish().
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

// A node's view of a value from another rate group. The reading graph owns it; it changes only in
// sample() or set(), so that all nodes of an activation read one version.
template <class T>
class Latest {
 public:
  // Binds to a buffer, which must outlive this object and have no other reader.
  void bind(TripleBuffer<T>& buffer) noexcept { buffer_ = &buffer; }
  // Sets a value without a buffer: a constant, a test's value, one from a recording.
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
