#include "platform/rt/clock.hpp"

#include <gtest/gtest.h>

#include <chrono>

#include "platform/rt/periodic_loop.hpp"

namespace glint {
namespace {

TEST(Clock, NeverRunsBackwardsAndIsTheOneOfTheStandardLibrary) {
  const Time first = monotonic_now();
  const auto steady = std::chrono::steady_clock::now().time_since_epoch();
  const Time second = monotonic_now();
  const std::int64_t between = std::chrono::duration_cast<std::chrono::nanoseconds>(steady).count();
  EXPECT_LE(first.nanoseconds, between);
  EXPECT_LE(between, second.nanoseconds);
}

TEST(Clock, GivesUnixTimeWithItsOffset) {
  const auto unix_now = [] {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(
               std::chrono::system_clock::now().time_since_epoch())
        .count();
  };
  const std::int64_t before = unix_now();
  const std::int64_t between = (monotonic_now() + unix_offset()).nanoseconds;
  const std::int64_t after = unix_now();
  EXPECT_GE(between, before - 1'000'000'000) << "a second: the clock may be set in between";
  EXPECT_LE(between, after + 1'000'000'000);
}

TEST(Clock, SleepsNoShorterThanAsked) {
  const Time wake = monotonic_now() + milliseconds(2);
  sleep_until(wake);
  EXPECT_GE(monotonic_now(), wake);
  sleep_until({0});  // long past: returns
}

TEST(PeriodicLoop, TiesEachTickToItsNominalTime) {
  const Time first = monotonic_now() + milliseconds(1);
  PeriodicLoop loop(first, milliseconds(1), 1'000'000);
  for (std::uint32_t n = 0; n < 5; ++n) {
    const Tick tick = loop.next();
    EXPECT_EQ(tick.number, n);
    EXPECT_EQ(tick.nominal, first + milliseconds(n));
    EXPECT_GE(tick.woken, tick.nominal);
    EXPECT_EQ(tick.skipped, 0u);
  }
}

TEST(PeriodicLoop, MakesUpForTicksThatItOwes) {
  const Time first = monotonic_now() - milliseconds(10);  // eleven ticks are due already
  PeriodicLoop loop(first, milliseconds(1), 1'000'000);
  for (std::uint32_t n = 0; n < 10; ++n) EXPECT_EQ(loop.next().number, n);
  EXPECT_EQ(loop.late(), 10u);
  EXPECT_EQ(loop.skipped(), 0u);
}

TEST(PeriodicLoop, SkipsWhatIsOwedForTooLongAndSaysSo) {
  const Duration hour = milliseconds(3'600'000);
  const Time first = monotonic_now() - hour * 30 - milliseconds(1'800'000);
  PeriodicLoop loop(first, hour, 25);
  const Tick tick = loop.next();
  EXPECT_EQ(tick.number, 30u);
  EXPECT_EQ(tick.skipped, 30u);
  EXPECT_EQ(tick.nominal, first + hour * 30);
  EXPECT_EQ(loop.skipped(), 30u);
}

}  // namespace
}  // namespace glint
