// Bounded ring buffer of variable-size records from one real-time thread to one writer thread.
//
// Records are contiguous, so that pixels are copied once. Wait-free on both sides; reserve()
// allocates and touches the memory. Cost: one acquire load, one release store. Worst input: a
// record that does not fit before the ring's end; the remaining blocks are unusable until they are
// read.
// Source: Lamport 1983, "Specifying concurrent program modules", bounded buffer of two counters.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace glint {

// View of one record. Its bytes are aligned to k_offer_alignment.
struct OfferSlot {
  std::uint32_t kind = 0;
  std::uint64_t ticket = 0;
  std::span<std::byte> bytes;
  [[nodiscard]] bool empty() const { return bytes.data() == nullptr; }
};

inline constexpr std::size_t k_offer_alignment = 32;

class OfferRing {
 public:
  void reserve(std::size_t bytes);

  // True if such a record fits into the empty ring at any start position: at most half of it.
  [[nodiscard]] bool ever_fits(std::size_t bytes) const noexcept {
    return bytes / sizeof(Block) + 2 <= blocks_ / 2;
  }

  // Producer: claim() returns space for one record of `bytes`, or empty(); publish() makes it
  // readable.
  [[nodiscard]] OfferSlot claim(std::size_t bytes) noexcept;
  void publish(const OfferSlot& slot) noexcept;

  // Consumer: front() returns the oldest record, or empty(); release() frees its space.
  [[nodiscard]] OfferSlot front() noexcept;
  void release() noexcept;

 private:
  struct alignas(k_offer_alignment) Block {
    std::byte bytes[k_offer_alignment];
  };
  struct Heading {
    std::uint64_t blocks;  // of the record, including this heading
    std::uint64_t payload_bytes;
    std::uint64_t ticket;
    std::uint32_t kind;
    bool is_gap;  // no record: the next one is at the ring's start
  };
  static_assert(sizeof(Heading) <= sizeof(Block));

  std::unique_ptr<Block[]> memory_;
  std::uint64_t blocks_ = 0;
  alignas(64) std::uint64_t claimed_ = 0;  // producer only: start of the record being filled
  std::atomic<std::uint64_t> pushed_{0};   // blocks published since the start
  alignas(64) std::atomic<std::uint64_t> popped_{0};  // blocks released since the start
};

}  // namespace glint
