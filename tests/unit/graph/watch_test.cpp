#include "graph/watch.hpp"

#include <gtest/gtest.h>

#include <array>

namespace glint::graph::watch_test {
namespace {

struct HandClock {
  std::int64_t now_ns = 0;
  std::int64_t elapsed_ns() const noexcept { return now_ns; }
};

constexpr std::array<std::int64_t, 3> k_remaining = {60, 30, 0};

DeadlineWatch<HandClock> watch_on(HandClock& clock, OverrunPolicy policy) {
  return {clock, 100, k_remaining, policy};
}

TEST(DeadlineWatch, GoesOnWhileWhatRemainsFits) {
  HandClock clock;
  auto watch = watch_on(clock, OverrunPolicy::predict);
  clock.now_ns = 40;
  EXPECT_TRUE(watch.go_on(0));
  clock.now_ns = 70;
  EXPECT_TRUE(watch.go_on(1));
  clock.now_ns = 100;
  EXPECT_TRUE(watch.go_on(2));
  EXPECT_EQ(watch.decision(), OverrunDecision{});
}

TEST(DeadlineWatch, SaysAheadOfTheDeadlineThatWhatRemainsNoLongerFits) {
  HandClock clock{71};
  auto watch = watch_on(clock, OverrunPolicy::hold_last);
  EXPECT_FALSE(watch.go_on(1));
  EXPECT_EQ(watch.decision(),
            (OverrunDecision{OverrunKind::will_miss, OverrunPolicy::hold_last, 1}));
}

TEST(DeadlineWatch, SaysThatTheDeadlineHasPassed) {
  HandClock clock{101};
  auto watch = watch_on(clock, OverrunPolicy::stop_safe);
  EXPECT_FALSE(watch.go_on(2));
  EXPECT_EQ(watch.decision(), (OverrunDecision{OverrunKind::missed, OverrunPolicy::stop_safe, 2}));
}

TEST(DeadlineWatch, NoticesOnlyAPassedDeadlineWithoutABound) {
  HandClock clock{100};
  DeadlineWatch<HandClock> watch(clock, 100, {}, OverrunPolicy::predict);
  EXPECT_TRUE(watch.go_on(0));
  clock.now_ns = 101;
  EXPECT_FALSE(watch.go_on(1));
}

// One nanosecond decides, with and without time reserved for the remaining nodes.
TEST(DeadlineWatch, EndsOneNanosecondBeyondWhatFits) {
  struct Case {
    int node;
    std::int64_t last_ns;  // latest time at which the remaining nodes still fit
  };
  for (const Case& c : {Case{0, 40}, Case{1, 70}, Case{2, 100}, Case{3, 100}}) {
    HandClock clock{c.last_ns};
    auto watch = watch_on(clock, OverrunPolicy::predict);
    EXPECT_TRUE(watch.go_on(c.node));
    EXPECT_FALSE(watch.decision().happened());
    ++clock.now_ns;
    EXPECT_FALSE(watch.go_on(c.node));
    EXPECT_TRUE(watch.decision().happened());
    const OverrunKind kind = c.last_ns < 100 ? OverrunKind::will_miss : OverrunKind::missed;
    EXPECT_EQ(watch.decision(),
              (OverrunDecision{kind, OverrunPolicy::predict, static_cast<std::uint8_t>(c.node)}));
  }
}

TEST(NoBoundary, NeverEndsAnActivation) {
  EXPECT_TRUE(NoBoundary::go_on(0));
  EXPECT_TRUE(NoBoundary::go_on(255));
}

TEST(OverrunPolicies, HaveTheNamesOfTheCellFile) {
  EXPECT_EQ(name_of(OverrunPolicy::skip_output), "skip_output");
  EXPECT_EQ(name_of(OverrunPolicy::hold_last), "hold_last");
  EXPECT_EQ(name_of(OverrunPolicy::predict), "predict");
  EXPECT_EQ(name_of(OverrunPolicy::stop_safe), "stop_safe");
}

TEST(RecordedBoundary, EndsWhereTheRecordingSaysAndNowhereWithoutADecision) {
  RecordedBoundary recorded({OverrunKind::will_miss, OverrunPolicy::predict, 4});
  EXPECT_TRUE(recorded.go_on(3));
  EXPECT_FALSE(recorded.go_on(4));
  RecordedBoundary none({});
  EXPECT_TRUE(none.go_on(0));
  EXPECT_TRUE(none.go_on(255));
}

}  // namespace
}  // namespace glint::graph::watch_test
