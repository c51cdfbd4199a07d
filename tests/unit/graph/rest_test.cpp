// Waiting of one worker: spins, checks, sleeps, and the number of sleeps that counts as an overrun.
#include "graph/rest.hpp"

#include <gtest/gtest.h>

namespace glint::graph::rest_test {
namespace {

// Counts its calls. A report ends the first `reported_sleeps` sleeps; the others time out.
struct ScriptedRest {
  std::uint32_t spins_allowed = 0;
  std::uint64_t reported_sleeps = 0;
  std::uint32_t reports = 100;
  int spins = 0;
  std::uint64_t sleeps = 0;
  std::uint32_t slept_with = 0;

  void spin() noexcept { ++spins; }
  [[nodiscard]] std::uint32_t spins_max() const noexcept { return spins_allowed; }
  [[nodiscard]] std::uint32_t progress() const noexcept { return reports; }
  [[nodiscard]] bool sleep(std::uint32_t seen) noexcept {
    slept_with = seen;
    return sleeps++ < reported_sleeps;
  }
  void report_progress() noexcept { ++reports; }
};
static_assert(WaitPolicy<ScriptedRest>);

struct Waited {
  bool is_done = false;
  int checks = 0;
  int go_on_calls = 0;
  std::uint64_t overruns = 0;
};

// Waits until check number `done_at` succeeds, or until `go_on_calls_max` calls to continue are
// used up.
Waited waited(ScriptedRest& rest, int done_at, int go_on_calls_max) {
  Waited result;
  std::atomic<std::uint64_t> overruns{0};
  result.is_done = wait_for(
      rest, overruns, [&] { return ++result.checks >= done_at; },
      [&] { return ++result.go_on_calls <= go_on_calls_max; });
  result.overruns = overruns.load();
  return result;
}

constexpr int k_never = 1 << 30, k_always = 1 << 30;

TEST(WaitFor, DoesNotRestWhereNothingIsLeftToWaitFor) {
  for (const std::uint32_t spins : {0U, 50U}) {
    ScriptedRest rest{.spins_allowed = spins};
    const Waited found = waited(rest, 1, 0);
    EXPECT_TRUE(found.is_done) << "even where the wait may not go on";
    EXPECT_EQ(found.checks, 1);
    EXPECT_EQ(rest.spins + static_cast<int>(rest.sleeps), 0);
  }
}

TEST(WaitFor, LooksOnceASpin) {
  ScriptedRest rest{.spins_allowed = 50};
  const Waited found = waited(rest, 15, k_always);
  EXPECT_TRUE(found.is_done);
  EXPECT_EQ(found.checks, 15);
  EXPECT_EQ(rest.spins, 14);
  EXPECT_EQ(rest.sleeps, 0U);
  EXPECT_EQ(found.go_on_calls, 0);
}

TEST(WaitFor, AsksEverySixteenthSpinWhetherToGoOn) {
  ScriptedRest rest{.spins_allowed = 1'000};
  const Waited found = waited(rest, k_never, 2);
  EXPECT_FALSE(found.is_done);
  EXPECT_EQ(found.go_on_calls, 3);
  EXPECT_EQ(found.checks, 48);
  EXPECT_EQ(rest.spins, 47);
  EXPECT_EQ(rest.sleeps, 0U);
}

TEST(WaitFor, SleepsOnlyAfterAllItsSpins) {
  ScriptedRest rest{.spins_allowed = 5};
  const Waited found = waited(rest, 5 + 3, k_always);
  EXPECT_TRUE(found.is_done);
  EXPECT_EQ(rest.spins, 5);
  EXPECT_EQ(rest.sleeps, 2U);
  EXPECT_EQ(found.go_on_calls, 2) << "before each sleep";
}

TEST(WaitFor, EndsBetweenTwoSleepsWhereItMayNotGoOn) {
  ScriptedRest rest{.spins_allowed = 5};
  const Waited found = waited(rest, k_never, 4);
  EXPECT_FALSE(found.is_done);
  EXPECT_EQ(rest.sleeps, 4U);
}

// A report between check and sleep must end the sleep: it receives the count from before the check.
TEST(WaitFor, SleepsByTheReportsThatItReadBeforeItLooked) {
  ScriptedRest rest;
  std::atomic<std::uint64_t> overruns{0};
  int checks = 0;
  const bool is_done = wait_for(
      rest, overruns,
      [&] {
        rest.report_progress();
        return ++checks > 1;
      },
      [] { return true; });
  EXPECT_TRUE(is_done);
  EXPECT_EQ(rest.sleeps, 1U);
  EXPECT_EQ(rest.slept_with, 100U);
}

TEST(WaitFor, CountsOneOverrunAfterTheSleepsThatAWaitMayLast) {
  const int sleeps_max = static_cast<int>(k_sleeps_max);
  for (const int sleeps : {sleeps_max - 1, sleeps_max, sleeps_max + 1, 5 * sleeps_max}) {
    ScriptedRest rest;
    const Waited found = waited(rest, sleeps + 1, k_always);
    EXPECT_TRUE(found.is_done);
    EXPECT_EQ(rest.sleeps, static_cast<std::uint64_t>(sleeps));
    EXPECT_EQ(found.overruns, sleeps < sleeps_max ? 0U : 1U) << sleeps;
  }
}

TEST(WaitFor, CountsNoSleepThatAReportEnded) {
  const int sleeps_max = static_cast<int>(k_sleeps_max);
  for (const int more : {sleeps_max - 1, sleeps_max}) {
    ScriptedRest rest{.reported_sleeps = 7};
    const Waited found = waited(rest, 7 + more + 1, k_always);
    EXPECT_EQ(rest.sleeps, static_cast<std::uint64_t>(7 + more));
    EXPECT_EQ(found.overruns, more < sleeps_max ? 0U : 1U);
  }
}

}  // namespace
}  // namespace glint::graph::rest_test
