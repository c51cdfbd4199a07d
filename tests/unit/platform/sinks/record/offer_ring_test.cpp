#include "platform/sinks/record/offer_ring.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <thread>

namespace glint {
namespace {

bool push(OfferRing& ring, std::uint64_t ticket, std::size_t bytes) {
  OfferSlot slot = ring.claim(bytes);
  if (slot.empty()) return false;
  slot.kind = static_cast<std::uint32_t>(bytes);
  slot.ticket = ticket;
  std::memset(slot.bytes.data(), static_cast<int>(ticket & 0x7FU), bytes);
  ring.publish(slot);
  return true;
}

void expect_front(OfferRing& ring, std::uint64_t ticket, std::size_t bytes) {
  const OfferSlot slot = ring.front();
  ASSERT_FALSE(slot.empty());
  ASSERT_EQ(slot.ticket, ticket);
  ASSERT_EQ(slot.kind, bytes);
  ASSERT_EQ(slot.bytes.size(), bytes);
  ASSERT_EQ(reinterpret_cast<std::uintptr_t>(slot.bytes.data()) % k_offer_alignment, 0U);
  for (const std::byte byte : slot.bytes) ASSERT_EQ(byte, std::byte(ticket & 0x7FU));
  ring.release();
}

TEST(OfferRing, GivesRecordsOfAnySizeBackInOrderAcrossItsEnd) {
  OfferRing ring;
  ring.reserve(1024);
  std::uint64_t written = 0, read = 0;
  const auto size_of = [](std::uint64_t ticket) { return 1 + ticket * 37 % 300; };
  while (read < 2000) {
    while (push(ring, written, size_of(written))) ++written;
    ASSERT_GT(written, read);
    expect_front(ring, read, size_of(read));
    ++read;
  }
}

TEST(OfferRing, IsFullBeforeItOverwrites) {
  OfferRing ring;
  ring.reserve(10 * 32);
  std::uint64_t count = 0;
  while (push(ring, count, 32)) ++count;
  EXPECT_EQ(count, 5U);  // a heading and a block each
  expect_front(ring, 0, 32);
  EXPECT_TRUE(push(ring, count, 32));
  EXPECT_FALSE(push(ring, count, 32));
}

TEST(OfferRing, RefusesForEverWhatIsLargerThanHalfOfIt) {
  OfferRing ring;
  ring.reserve(1024);
  EXPECT_FALSE(ring.ever_fits(512));
  EXPECT_TRUE(ring.claim(512).empty());
  EXPECT_TRUE(ring.ever_fits(448));
}

TEST(OfferRing, TakesWhatEverFitsWheneverItIsEmpty) {
  OfferRing ring;
  ring.reserve(1024);
  for (std::uint64_t i = 0; i < 100; ++i) {
    ASSERT_TRUE(push(ring, i, i % 2 == 0 ? 448 : 1));
    expect_front(ring, i, i % 2 == 0 ? 448 : 1);
  }
}

// A record of up to half the ring, heading included, always fits; a larger one never.
TEST(OfferRing, EverTakesARecordOfHalfOfIt) {
  for (std::size_t blocks = 0; blocks <= 12; ++blocks) {
    OfferRing ring;
    ring.reserve(blocks * k_offer_alignment);
    for (std::size_t bytes = 0; bytes <= blocks * k_offer_alignment; ++bytes) {
      const std::size_t needed = 2 + bytes / k_offer_alignment;  // one more for a full block
      EXPECT_EQ(ring.ever_fits(bytes), needed <= blocks / 2) << blocks << ' ' << bytes;
      EXPECT_EQ(ring.claim(bytes).empty(), !ring.ever_fits(bytes)) << blocks << ' ' << bytes;
    }
  }
}

TEST(OfferRing, HasRoomForTheLastByteThatItReserved) {
  OfferRing exact, more;
  exact.reserve(4 * k_offer_alignment);
  more.reserve(3 * k_offer_alignment + 1);
  EXPECT_TRUE(exact.ever_fits(1));
  EXPECT_TRUE(more.ever_fits(1)) << "rounded up";
  OfferRing none;
  EXPECT_FALSE(none.ever_fits(0));
  EXPECT_TRUE(none.claim(0).empty());
  EXPECT_TRUE(none.front().empty());
}

TEST(OfferRing, IsEmptyWhenItIsReservedAnew) {
  OfferRing ring;
  ring.reserve(1024);
  for (std::uint64_t i = 0; i < 7; ++i) ASSERT_TRUE(push(ring, i, 32));
  expect_front(ring, 0, 32);
  ring.reserve(512);
  EXPECT_TRUE(ring.front().empty());
  std::uint64_t count = 0;
  while (push(ring, count, 32)) ++count;
  EXPECT_EQ(count, 8U);
  for (std::uint64_t i = 0; i < count; ++i) expect_front(ring, i, 32);
}

// Two record sizes at every offset: a record that does not fit before the ring's end starts at its
// beginning, and no record is overwritten.
TEST(OfferRing, LeavesTheRestBeforeItsEndOutWhereARecordDoesNotFit) {
  constexpr std::size_t k_blocks = 16;
  for (std::size_t first = 1; first <= 6; ++first) {
    for (std::size_t second = 1; second <= 6; ++second) {
      OfferRing ring;
      ring.reserve(k_blocks * k_offer_alignment);
      std::uint64_t written = 0, read = 0;
      const auto size_of = [&](std::uint64_t ticket) {
        return k_offer_alignment * (ticket % 2 == 0 ? first : second);
      };
      while (read < 60) {
        while (push(ring, written, size_of(written))) ++written;
        ASSERT_GT(written, read) << first << ' ' << second;
        expect_front(ring, read, size_of(read));
        ++read;
      }
    }
  }
}

TEST(OfferRing, HandsOverBetweenTwoThreads) {
  OfferRing ring;
  ring.reserve(2048);
  constexpr std::uint64_t k_count = 20'000;
  std::thread producer([&] {
    for (std::uint64_t i = 0; i < k_count;)
      if (push(ring, i, 1 + i % 200))
        ++i;
      else
        std::this_thread::yield();
  });
  for (std::uint64_t i = 0; i < k_count;) {
    if (ring.front().empty()) {
      std::this_thread::yield();
      continue;
    }
    const OfferSlot slot = ring.front();
    EXPECT_EQ(slot.ticket, i);
    EXPECT_EQ(slot.bytes.back(), std::byte(i & 0x7FU));
    ring.release();
    ++i;
  }
  producer.join();
  EXPECT_TRUE(ring.front().empty());
}

}  // namespace
}  // namespace glint
