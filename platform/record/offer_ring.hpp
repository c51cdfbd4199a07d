// A bounded ring of records of any size between one real-time thread and one writing thread.
//
// Records lie in one piece, so that pixels are copied once. Wait-free on both sides; the memory is
// taken and touched by reserve(). Cost: one acquire load, one release store; worst input: a record
// that does not fit before the ring's end, which costs the rest of the ring until it is read.
// Source: Lamport 1983, "Specifying concurrent program modules", bounded buffer of two counters.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace glint {

// One record as both sides see it. Its bytes are aligned to k_offer_alignment.
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

  // Whether such a record has room in the empty ring, wherever in it the last one ended: half of
  // it.
  [[nodiscard]] bool ever_fits(std::size_t bytes) const noexcept {
    return bytes / sizeof(Block) + 2 <= blocks_ / 2;
  }

  // Producer: room for one record of `bytes`, empty() if there is none; then hand it over.
  [[nodiscard]] OfferSlot claim(std::size_t bytes) noexcept;
  void publish(const OfferSlot& slot) noexcept;

  // Consumer: the oldest record, empty() if there is none; then give its room back.
  [[nodiscard]] OfferSlot front() noexcept;
  void release() noexcept;

 private:
  struct alignas(k_offer_alignment) Block {
    std::byte bytes[k_offer_alignment];
  };
  struct Heading {
    std::uint64_t blocks;  // of the record, with this heading
    std::uint64_t payload_bytes;
    std::uint64_t ticket;
    std::uint32_t kind;
    bool is_gap;  // nothing here: the next record is at the ring's start
  };
  static_assert(sizeof(Heading) <= sizeof(Block));

  std::unique_ptr<Block[]> memory_;
  std::uint64_t blocks_ = 0;
  alignas(64) std::uint64_t claimed_ = 0;  // producer's own: where the record being filled starts
  std::atomic<std::uint64_t> pushed_{0};   // blocks ever handed over
  alignas(64) std::atomic<std::uint64_t> popped_{0};  // blocks ever given back
};

}  // namespace glint
