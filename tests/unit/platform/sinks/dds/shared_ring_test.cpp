#include "platform/sinks/dds/shared_ring.hpp"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

namespace glint {
namespace {

struct Shared {
  RingPositions positions;
  std::vector<std::uint8_t> memory = std::vector<std::uint8_t>(256);
};

std::vector<std::uint8_t> contents(std::size_t size, int first) {
  std::vector<std::uint8_t> bytes(size);
  for (std::size_t i = 0; i < size; ++i)
    bytes[i] = static_cast<std::uint8_t>(first + static_cast<int>(i));
  return bytes;
}

// Sizes up to the whole ring, so that records wrap at every position.
TEST(SharedRing, ReturnsWhatWasPushedInOrder) {
  Shared shared;
  RingProducer producer(shared.positions, shared.memory);
  RingConsumer consumer(shared.positions, shared.memory);
  RingRecord record;
  std::vector<std::uint8_t> bytes;
  for (int i = 0; i < 2000; ++i) {
    const auto sent = contents(static_cast<std::size_t>(i % 241), i);
    ASSERT_TRUE(producer.push({7, 0, static_cast<std::uint16_t>(i), RecordKind::message}, sent));
    ASSERT_EQ(consumer.pop(record, bytes), RingResult::taken);
    EXPECT_EQ(record.endpoint, i);
    EXPECT_EQ(record.sender, 7u);
    ASSERT_EQ(bytes, sent);
  }
  EXPECT_EQ(consumer.pop(record, bytes), RingResult::empty);
}

TEST(SharedRing, RefusesARecordForWhichThereIsNoRoom) {
  Shared shared;
  RingProducer producer(shared.positions, shared.memory);
  RingConsumer consumer(shared.positions, shared.memory);
  EXPECT_FALSE(producer.push({}, contents(241, 0)));
  int pushed = 0;
  while (producer.push({}, contents(16, pushed))) ++pushed;
  EXPECT_EQ(pushed, 8);  // 16 bytes of header and 16 of contents
  RingRecord record;
  std::vector<std::uint8_t> bytes;
  ASSERT_EQ(consumer.pop(record, bytes), RingResult::taken);
  EXPECT_TRUE(producer.push({}, contents(16, pushed)));
  EXPECT_FALSE(producer.push({}, {}));
}

TEST(SharedRing, CarriesEveryRecordBetweenThreads) {
  Shared shared;
  constexpr int k_count = 20'000;
  std::thread producing([&] {
    RingProducer producer(shared.positions, shared.memory);
    for (int i = 0; i < k_count;) {
      if (producer.push({}, contents(static_cast<std::size_t>(i % 50), i))) {
        ++i;
      } else {
        std::this_thread::yield();
      }
    }
  });
  RingConsumer consumer(shared.positions, shared.memory);
  RingRecord record;
  std::vector<std::uint8_t> bytes;
  int wrong = 0;
  for (int i = 0; i < k_count;) {
    if (consumer.pop(record, bytes) == RingResult::empty) {
      std::this_thread::yield();
      continue;
    }
    wrong += bytes == contents(static_cast<std::size_t>(i % 50), i) ? 0 : 1;
    ++i;
  }
  producing.join();
  EXPECT_EQ(wrong, 0);
}

// The other process wrote positions or lengths that cannot be.
TEST(SharedRing, RecognisesABrokenProducer) {
  for (const std::uint64_t written :
       {std::uint64_t{1}, std::uint64_t{15}, std::uint64_t{257}, UINT64_MAX}) {
    Shared shared;
    shared.positions.written = written;
    RingConsumer consumer(shared.positions, shared.memory);
    RingRecord record;
    std::vector<std::uint8_t> bytes;
    EXPECT_EQ(consumer.pop(record, bytes), RingResult::broken) << written;
  }
  Shared shared;
  RingProducer producer(shared.positions, shared.memory);
  ASSERT_TRUE(producer.push({}, contents(8, 0)));
  shared.memory[8] = 9 + 8;  // the record's length
  RingConsumer consumer(shared.positions, shared.memory);
  RingRecord record;
  std::vector<std::uint8_t> bytes;
  EXPECT_EQ(consumer.pop(record, bytes), RingResult::broken);
}

TEST(SharedRing, WritesNothingOutsideItForABrokenConsumer) {
  Shared shared;
  RingProducer producer(shared.positions, shared.memory);
  shared.positions.read = 1'000'000;  // more than was written
  EXPECT_FALSE(producer.push({}, contents(8, 0)));
}

}  // namespace
}  // namespace glint
