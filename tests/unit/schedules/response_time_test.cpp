#include "schedules/response_time.hpp"

#include <gtest/gtest.h>

#include <array>

namespace glint::response_time_test {
namespace {

// Joseph and Pandya's recurrence at compile time, as the build of a companion computer asserts it.
constexpr std::array<Interference, 2> k_two = {{{3, 7, 0}, {3, 12, 0}}};
static_assert(response_time({5, 20, 0, 0}, k_two)->response_ns == 20);

// Burns and Wellings, "Real-Time Systems and Programming Languages", the set (3,7), (3,12), (5,20).
TEST(ResponseTime, OfBurnsAndWellingsThreeTasksAre3And6And20) {
  EXPECT_EQ(response_time({3, 7, 0, 0}, {})->response_ns, 3);
  EXPECT_EQ(response_time({3, 12, 0, 0}, std::span(k_two).first(1))->response_ns, 6);
  EXPECT_EQ(response_time({5, 20, 0, 0}, k_two)->response_ns, 20);
  EXPECT_EQ(response_time({5, 20, 0, 0}, k_two)->preempted_ns, 15);
}

// Lehoczky 1990, set (26,70), (62,100): the first activation ends after 114, the fifth 118 after
// its release; the busy period has seven activations.
TEST(ResponseTime, OfLehoczkysSetIsWorstInTheFifthActivation) {
  constexpr std::array<Interference, 1> k_higher_priority = {{{26, 70, 0}}};
  const auto found = response_time({62, 100, 0, 0}, k_higher_priority);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->response_ns, 118);
  EXPECT_EQ(found->activations, 7);
}

TEST(ResponseTime, AddsJitterAndBlocking) {
  constexpr std::array<Interference, 1> k_higher_priority = {{{2, 10, 3}}};
  // Own work 4, blocking 3, two releases of the other within 11 + 3.
  EXPECT_EQ(response_time({4, 50, 5, 3}, k_higher_priority)->response_ns, 5 + 4 + 3 + 2 * 2);
}

// Not const: the compiler would evaluate the recurrence to its end, which takes ten seconds.
TEST(ResponseTime, HasNoBoundAboveFullLoad) {
  std::array<Interference, 1> higher = {{{6, 10, 0}}};
  EXPECT_FALSE(response_time({5, 10, 0, 0}, higher));
  std::array<Interference, 1> undeclared = {{{1, 0, 0}}};
  EXPECT_FALSE(response_time({5, 10, 0, 0}, undeclared));
}

// Lehoczky's fifth activation ends 518 after the start of the busy period: 310 for five of its own
// activations, 208 for eight of the higher-priority task's.
TEST(ResponseTime, StatesWhatPreemptionTookOfTheWorstActivation) {
  constexpr std::array<Interference, 1> k_higher_priority = {{{26, 70, 0}}};
  EXPECT_EQ(response_time({62, 100, 0, 0}, k_higher_priority)->preempted_ns, 8 * 26);
  EXPECT_EQ(response_time({4, 50, 5, 3}, {})->preempted_ns, 0) << "blocking is no preemption";
}

TEST(ResponseTime, LooksAtOneActivationWhereTheNextComesAfterIt) {
  EXPECT_EQ(response_time({10, 10, 0, 0}, {})->activations, 1);
  EXPECT_EQ(response_time({10, 11, 1, 0}, {})->activations, 1);
  EXPECT_EQ(response_time({10, 0, 0, 0}, {})->activations, 1) << "no gap is declared";
  EXPECT_EQ(response_time({10, 12, 5, 0}, {})->activations, 3);
  EXPECT_EQ(response_time({10, 12, 5, 0}, {})->response_ns, 15) << "the first is the latest";
  WorkUnderAnalysis late{10, 10, 1, 0};
  EXPECT_FALSE(response_time(late, {})) << "the busy period never ends";
}

TEST(BusyWindow, EndsAtItsLimitAndNotBefore) {
  for (const std::int64_t limit : {20, 19}) {
    int steps = 100;
    EXPECT_EQ(busy_window(5, k_two, limit, 0, steps).has_value(), limit == 20);
  }
}

// Iterates from 5: 11, 14, 17, 20, 20.
TEST(BusyWindow, TakesAStepForEachLookAndEndsWithTheLast) {
  for (const int allowed : {5, 4}) {
    int steps = allowed;
    const auto window = busy_window(5, k_two, 1'000, 0, steps);
    EXPECT_EQ(window.has_value(), allowed == 5);
    EXPECT_LE(steps, 0);
  }
  int steps = 7;
  EXPECT_EQ(busy_window(5, k_two, 1'000, 20, steps), 20);
  EXPECT_EQ(steps, 6) << "from a lower bound that holds all";
  EXPECT_EQ(busy_window(5, k_two, 1'000, 18, steps), 20);
  EXPECT_EQ(steps, 4);
}

TEST(BusyWindow, CountsAnUrgentReleaseOnceItsJitterBringsItIn) {
  const auto window = [](std::int64_t jitter) {
    const std::array<Interference, 1> higher = {{{2, 10, jitter}}};
    int steps = 100;
    return *busy_window(6, higher, 1'000, 0, steps);
  };
  EXPECT_EQ(window(0), 8);
  EXPECT_EQ(window(2), 8);
  EXPECT_EQ(window(3), 10) << "8 and 3 are more than its gap";
}

TEST(BusyWindow, CountsWorkThatTakesNoTimeForNothing) {
  const std::array<Interference, 2> idle = {{{0, 0, 0}, {0, 1, 5}}};
  int steps = 100;
  EXPECT_EQ(busy_window(6, idle, 1'000, 0, steps), 6);
  const std::array<Interference, 1> one = {{{1, 10, 0}}};
  EXPECT_EQ(busy_window(6, one, 1'000, 0, steps), 7);
}

}  // namespace
}  // namespace glint::response_time_test
