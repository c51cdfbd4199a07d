#include "schedules/response_time.hpp"

#include <gtest/gtest.h>

#include <array>

namespace glint::response_time_test {
namespace {

// Joseph and Pandya's recurrence at compile time: what a board's build asserts.
constexpr std::array<Interference, 2> k_two = {{{3, 7, 0}, {3, 12, 0}}};
static_assert(response_time({5, 20, 0, 0}, k_two)->response_ns == 20);

// Burns and Wellings, "Real-Time Systems and Programming Languages", the set (3,7), (3,12), (5,20).
TEST(ResponseTime, OfBurnsAndWellingsThreeTasksAre3And6And20) {
  EXPECT_EQ(response_time({3, 7, 0, 0}, {})->response_ns, 3);
  EXPECT_EQ(response_time({3, 12, 0, 0}, std::span(k_two).first(1))->response_ns, 6);
  EXPECT_EQ(response_time({5, 20, 0, 0}, k_two)->response_ns, 20);
  EXPECT_EQ(response_time({5, 20, 0, 0}, k_two)->preempted_ns, 15);
}

// Lehoczky 1990, the set (26,70), (62,100): the first activation ends after 114, the fifth 118
// after its release, and the busy period has seven.
TEST(ResponseTime, OfLehoczkysSetIsWorstInTheFifthActivation) {
  constexpr std::array<Interference, 1> k_urgent = {{{26, 70, 0}}};
  const auto found = response_time({62, 100, 0, 0}, k_urgent);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->response_ns, 118);
  EXPECT_EQ(found->activations, 7);
}

TEST(ResponseTime, AddsJitterAndBlocking) {
  constexpr std::array<Interference, 1> k_urgent = {{{2, 10, 3}}};
  // 4 of its own, 3 of blocking, two releases of the other within 11 + 3.
  EXPECT_EQ(response_time({4, 50, 5, 3}, k_urgent)->response_ns, 5 + 4 + 3 + 2 * 2);
}

// Not const: the compiler would follow the recurrence to its end, which takes it ten seconds.
TEST(ResponseTime, HasNoBoundAboveFullLoad) {
  std::array<Interference, 1> urgent = {{{6, 10, 0}}};
  EXPECT_FALSE(response_time({5, 10, 0, 0}, urgent));
  std::array<Interference, 1> undeclared = {{{1, 0, 0}}};
  EXPECT_FALSE(response_time({5, 10, 0, 0}, undeclared));
}

}  // namespace
}  // namespace glint::response_time_test
