#include "platform/sinks/dds/stream_counter.hpp"

#include <gtest/gtest.h>

namespace glint {
namespace {

constexpr Time k_start{1'000'000'000};
constexpr Duration k_tick = milliseconds(4);

StreamMark at(std::int64_t tick, std::uint64_t not_sent = 0) {
  return {k_start + k_tick * tick, k_start, k_tick, not_sent};
}

TEST(StreamCounters, MissNothingInAnUnbrokenStream) {
  StreamCounter counter;
  for (int tick = 0; tick < 100; ++tick) counter.add(at(tick));
  counter.end(at(100));
  EXPECT_EQ(counter.received(), 100u);
  EXPECT_EQ(counter.missed(), 0u);
  EXPECT_TRUE(counter.ended());
}

TEST(StreamCounters, MissWhatIsGoneBeforeWithinAndAfter) {
  StreamCounter counter;
  counter.add(at(3));
  counter.add(at(4));
  counter.add(at(7));
  counter.end(at(10));
  EXPECT_EQ(counter.received(), 3u);
  EXPECT_EQ(counter.missed(), 3u + 2u + 2u);
}

TEST(StreamCounters, MissAllWhereOnlyTheEndCame) {
  StreamCounter counter;
  counter.end(at(50, 10));
  EXPECT_EQ(counter.received(), 0u);
  EXPECT_EQ(counter.missed(), 40u);
}

TEST(StreamCounters, DoNotCallMissedWhatWasNeverSent) {
  StreamCounter counter;
  counter.add(at(0));
  counter.add(at(11, 10));  // all ten in between were dropped before sending
  counter.add(at(15, 11));  // one of the three in between
  EXPECT_EQ(counter.missed(), 2u);
}

TEST(StreamCounters, CountAStampOnlyOnce) {
  StreamCounter counter;
  counter.add(at(0));
  counter.add(at(5));
  counter.add(at(5));
  counter.add(at(2));
  EXPECT_EQ(counter.received(), 2u);
  EXPECT_EQ(counter.missed(), 4u);
}

TEST(StreamCounters, BeginAnewWhenTheSinkWasRestarted) {
  StreamCounter counter;
  counter.add(at(0));
  counter.add(at(1));
  const Time again{k_start.nanoseconds + 77'777'777'777};
  counter.add({again + k_tick, again, k_tick, 0});
  EXPECT_EQ(counter.received(), 3u);
  EXPECT_EQ(counter.missed(), 1u);
}

// 300 Hz: not a whole number of nanoseconds. Rounding errors must not accumulate over a day.
TEST(StreamCounters, DoNotDriftWhereAPeriodIsNoWholeNumber) {
  StreamCounter counter;
  constexpr std::int64_t day = 300LL * 86'400;
  constexpr Duration period{3'333'333};
  for (std::int64_t tick = 0; tick <= day; tick += 2) {
    counter.add({k_start + Duration{tick * 1'000'000'000 / 300}, k_start, period, 0});
  }
  EXPECT_EQ(counter.received(), static_cast<std::uint64_t>(day / 2 + 1));
  EXPECT_EQ(counter.missed(), static_cast<std::uint64_t>(day / 2));
}

TEST(StreamCounters, IgnoreMarksThatCannotBe) {
  StreamCounter counter;
  counter.add({k_start, k_start, Duration{}, 0});
  counter.add(at(2, 5));  // more unsent messages than elapsed ticks
  EXPECT_EQ(counter.received(), 0u);
  EXPECT_EQ(counter.missed(), 0u);
}

}  // namespace
}  // namespace glint
