// Bounded queue of records in memory that two processes share: one producer, one consumer, no lock,
// no heap.
//
// Neither side trusts the other: each keeps its own position, copies a record's header before it
// checks it, and never accesses memory outside the ring. A full ring refuses the record.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "graph/port.hpp"

namespace glint {

enum class RecordKind : std::uint16_t {
  message,      // serialised message of an endpoint
  create,       // NewEndpoint
  remove,       // the endpoint ends
  flush,        // Flush: waits for the readers' acknowledgements
  end,          // the process ends
  sender_left,  // no more messages of this sender; 0: of any sender
};

struct RingRecord {
  std::uint64_t sender = 0;  // handle of the message's publisher
  std::uint32_t bytes = 0;   // that follow
  std::uint16_t endpoint = 0;
  RecordKind kind = RecordKind::message;
};

// Bytes written and read since the start. In the shared memory.
struct RingPositions {
  alignas(graph::k_cache_line) std::atomic<std::uint64_t> written{0};
  alignas(graph::k_cache_line) std::atomic<std::uint64_t> read{0};
};
static_assert(std::atomic<std::uint64_t>::is_always_lock_free);

inline constexpr std::uint64_t k_record_alignment = 8;

[[nodiscard]] constexpr std::uint64_t ring_bytes_of(std::uint64_t bytes) noexcept {
  return sizeof(RingRecord) +
         (bytes + k_record_alignment - 1) / k_record_alignment * k_record_alignment;
}

class RingProducer {
 public:
  RingProducer(RingPositions& positions, std::span<std::uint8_t> memory) noexcept
      : positions_(&positions), memory_(memory) {}

  // `record.bytes` is set here. Returns false if there is no room.
  bool push(RingRecord record, std::span<const std::uint8_t> bytes) noexcept {
    const std::uint64_t used =
        written_ - positions_->read.load(std::memory_order_acquire);  // huge: a corrupt position
    const std::uint64_t room = memory_.size() - std::min<std::uint64_t>(used, memory_.size());
    if (ring_bytes_of(bytes.size()) > room) return false;
    record.bytes = static_cast<std::uint32_t>(bytes.size());
    put(written_, {reinterpret_cast<const std::uint8_t*>(&record), sizeof record});
    put(written_ + sizeof record, bytes);
    written_ += ring_bytes_of(bytes.size());
    positions_->written.store(written_, std::memory_order_release);
    return true;
  }

 private:
  void put(std::uint64_t at, std::span<const std::uint8_t> bytes) noexcept {
    if (bytes.empty()) return;
    const std::size_t start = at % memory_.size();
    const std::size_t first = std::min(bytes.size(), memory_.size() - start);
    std::memcpy(memory_.data() + start, bytes.data(), first);
    if (first < bytes.size()) {
      std::memcpy(memory_.data(), bytes.data() + first, bytes.size() - first);
    }
  }

  RingPositions* positions_;
  std::span<std::uint8_t> memory_;
  std::uint64_t written_ = 0;
};

enum class RingResult : std::uint8_t { empty, taken, broken };

class RingConsumer {
 public:
  RingConsumer(RingPositions& positions, std::span<const std::uint8_t> memory) noexcept
      : positions_(&positions), memory_(memory) {}

  // Copies the oldest record. Reserve `bytes` for the largest one to allocate nothing. `broken`:
  // the producer wrote positions or lengths that cannot be; the ring is unusable.
  [[nodiscard]] RingResult pop(RingRecord& record, std::vector<std::uint8_t>& bytes) {
    const std::uint64_t available = positions_->written.load(std::memory_order_acquire) - read_;
    if (available == 0) return RingResult::empty;
    if (available > memory_.size() || available < sizeof record) return RingResult::broken;
    get(read_, {reinterpret_cast<std::uint8_t*>(&record), sizeof record});
    if (ring_bytes_of(record.bytes) > available) return RingResult::broken;
    bytes.resize(record.bytes);
    get(read_ + sizeof record, bytes);
    read_ += ring_bytes_of(record.bytes);
    positions_->read.store(read_, std::memory_order_release);
    return RingResult::taken;
  }

 private:
  void get(std::uint64_t at, std::span<std::uint8_t> bytes) const noexcept {
    if (bytes.empty()) return;
    const std::size_t start = at % memory_.size();
    const std::size_t first = std::min(bytes.size(), memory_.size() - start);
    std::memcpy(bytes.data(), memory_.data() + start, first);
    if (first < bytes.size()) {
      std::memcpy(bytes.data() + first, memory_.data(), bytes.size() - first);
    }
  }

  RingPositions* positions_;
  std::span<const std::uint8_t> memory_;
  std::uint64_t read_ = 0;
};

}  // namespace glint
