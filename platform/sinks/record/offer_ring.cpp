#include "platform/sinks/record/offer_ring.hpp"

#include <new>

namespace glint {

void OfferRing::reserve(std::size_t bytes) {
  blocks_ = (bytes + sizeof(Block) - 1) / sizeof(Block);
  memory_ = std::make_unique<Block[]>(blocks_);  // zeroed, so that every page is resident
  pushed_.store(0, std::memory_order_relaxed);
  popped_.store(0, std::memory_order_relaxed);
}

OfferSlot OfferRing::claim(std::size_t bytes) noexcept {
  const std::uint64_t needed = 1 + (bytes + sizeof(Block) - 1) / sizeof(Block);
  if (!ever_fits(bytes)) return {};
  const std::uint64_t pushed = pushed_.load(std::memory_order_relaxed);
  const std::uint64_t free = blocks_ - (pushed - popped_.load(std::memory_order_acquire));
  const std::uint64_t to_end = blocks_ - pushed % blocks_;
  const std::uint64_t gap = needed > to_end ? to_end : 0;
  if (gap + needed > free) return {};
  if (gap > 0) new (&memory_[pushed % blocks_]) Heading{gap, 0, 0, 0, true};
  claimed_ = pushed + gap;
  Block* heading = &memory_[claimed_ % blocks_];
  new (heading) Heading{needed, bytes, 0, 0, false};
  return {0, 0, {heading[1].bytes, bytes}};
}

void OfferRing::publish(const OfferSlot& slot) noexcept {
  auto* heading = std::launder(reinterpret_cast<Heading*>(&memory_[claimed_ % blocks_]));
  heading->kind = slot.kind;
  heading->ticket = slot.ticket;
  pushed_.store(claimed_ + heading->blocks, std::memory_order_release);
}

OfferSlot OfferRing::front() noexcept {
  for (;;) {
    const std::uint64_t popped = popped_.load(std::memory_order_relaxed);
    if (popped == pushed_.load(std::memory_order_acquire)) return {};
    Block* block = &memory_[popped % blocks_];
    const auto* heading = std::launder(reinterpret_cast<const Heading*>(block));
    if (!heading->is_gap)
      return {heading->kind, heading->ticket, {block[1].bytes, heading->payload_bytes}};
    popped_.store(popped + heading->blocks, std::memory_order_release);
  }
}

void OfferRing::release() noexcept {
  const std::uint64_t popped = popped_.load(std::memory_order_relaxed);
  const auto* heading = std::launder(reinterpret_cast<const Heading*>(&memory_[popped % blocks_]));
  popped_.store(popped + heading->blocks, std::memory_order_release);
}

}  // namespace glint
