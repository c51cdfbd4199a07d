#include "platform/runtime/rt/clock.hpp"

#include <dlfcn.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <ctime>

#include "platform/runtime/rt/periodic_loop.hpp"

// Replaces the C library's function, which it calls unless a test makes it fail.
namespace {
std::atomic<bool> g_sleep_is_refused{false};
}  // namespace

extern "C" int clock_nanosleep(clockid_t clock, int flags, const timespec* until, timespec* rest) {
  if (g_sleep_is_refused) return EPERM;
  static const auto original =
      reinterpret_cast<decltype(&clock_nanosleep)>(dlsym(RTLD_NEXT, "clock_nanosleep"));
  return original(clock, flags, until, rest);
}

namespace glint {
namespace {

// Fails as under a filter of system calls.
struct RefusedSleep {
  RefusedSleep() { g_sleep_is_refused = true; }
  ~RefusedSleep() { g_sleep_is_refused = false; }
  RefusedSleep(const RefusedSleep&) = delete;
  RefusedSleep& operator=(const RefusedSleep&) = delete;
};

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
  EXPECT_TRUE(sleep_until(wake));
  EXPECT_GE(monotonic_now(), wake);
  EXPECT_TRUE(sleep_until({0}));  // already past: returns at once
}

TEST(Clock, ReportsThatTheSystemRefusesToSleep) {
  const RefusedSleep refused;
  EXPECT_FALSE(sleep_until(monotonic_now() + milliseconds(3'600'000)));
}

TEST(PeriodicLoop, TiesEachTickToItsNominalTime) {
  const Time first = monotonic_now() + milliseconds(1);
  PeriodicLoop loop(first, milliseconds(1), 1'000'000);
  for (std::uint64_t n = 0; n < 5; ++n) {
    const Tick tick = loop.next().value();
    EXPECT_EQ(tick.number, n);
    EXPECT_EQ(tick.nominal, first + milliseconds(static_cast<std::int64_t>(n)));
    EXPECT_GE(tick.woken, tick.nominal);
    EXPECT_EQ(tick.skipped, 0u);
  }
}

TEST(PeriodicLoop, MakesUpForTicksThatItOwes) {
  const Time first = monotonic_now() - milliseconds(10);  // eleven ticks are due already
  PeriodicLoop loop(first, milliseconds(1), 1'000'000);
  for (std::uint64_t n = 0; n < 10; ++n) EXPECT_EQ(loop.next().value().number, n);
  EXPECT_EQ(loop.late(), 10u);
  EXPECT_EQ(loop.skipped(), 0u);
}

TEST(PeriodicLoop, SkipsWhatIsOwedForTooLongAndSaysSo) {
  const Duration hour = milliseconds(3'600'000);
  const Time first = monotonic_now() - hour * 30 - milliseconds(1'800'000);
  PeriodicLoop loop(first, hour, 25);
  const Tick tick = loop.next().value();
  EXPECT_EQ(tick.number, 30u);
  EXPECT_EQ(tick.skipped, 30u);
  EXPECT_EQ(tick.nominal, first + hour * 30);
  EXPECT_EQ(loop.skipped(), 30u);
}

// A 1 kHz loop after 49.7 days.
TEST(PeriodicLoop, KeepsItsPeriodBeyondTwoToThe32Ticks) {
  constexpr std::uint64_t k_wrap = std::uint64_t{1} << 32;
  const Duration period = milliseconds(1);
  const Time first = monotonic_now() - period * static_cast<std::int64_t>(k_wrap - 3);
  PeriodicLoop loop(first, period);
  std::uint64_t last = 0;
  std::uint64_t ran = 0;
  for (; ran < 10 || last < k_wrap + 3; ++ran) {
    const Tick tick = loop.next().value();
    ASSERT_GE(tick.number, k_wrap - 3);
    ASSERT_EQ(tick.nominal, first + period * static_cast<std::int64_t>(tick.number));
    ASSERT_GE(tick.woken, tick.nominal) << "it did not wait for tick " << tick.number;
    ASSERT_EQ(tick.number, ran + loop.skipped());
    last = tick.number;
  }
}

TEST(PeriodicLoop, EndsWhereTheSystemRefusesToSleep) {
  PeriodicLoop loop(monotonic_now() + milliseconds(3'600'000), milliseconds(1));
  const RefusedSleep refused;
  EXPECT_FALSE(loop.next());
  EXPECT_FALSE(loop.next());
}

TEST(PeriodicLoop, EndsWhereASleepReturnsTooEarly) {
  PeriodicLoop loop(monotonic_now() + milliseconds(3'600'000), milliseconds(1), 25,
                    [](Time) noexcept { return true; });
  EXPECT_FALSE(loop.next());
}

}  // namespace
}  // namespace glint
