#include "schedules/can_response.hpp"

#include <gtest/gtest.h>

namespace glint::can_response_test {
namespace {

constexpr std::int64_t k_ms = 1'000'000;

// Davis, Burns, Bril, Lukkien 2007, table 1: 125 bits each at 125 kbit/s, 1 ms a frame.
std::vector<CanMessage> davis_2007() {
  std::vector<CanMessage> messages(3);
  const std::int64_t period[] = {2'500'000, 3'500'000, 3'500'000};
  const std::int64_t deadline[] = {2'500'000, 3'250'000, 3'250'000};
  for (std::size_t m = 0; m < 3; ++m) {
    messages[m].name = std::string(1, static_cast<char>('A' + m));
    messages[m].identifier = static_cast<std::uint32_t>(m + 1);
    messages[m].shape.data_bytes = 7;
    messages[m].period_ns = period[m];
    messages[m].deadline_ns = deadline[m];
    messages[m].node = static_cast<int>(m);
  }
  return messages;
}

TEST(CanResponse, OfDavis2007sThreeMessagesAre2And3And3AndAHalfMilliseconds) {
  const std::vector<CanResponse> found = can_responses(davis_2007(), {.nominal = 125e3});
  EXPECT_EQ(found[0].frame_ns, 1 * k_ms);
  EXPECT_EQ(found[0].response_ns, 2 * k_ms);
  EXPECT_EQ(found[1].response_ns, 3 * k_ms);
  // The first of C's frames takes 3 ms; the original analysis stopped there. The second takes more
  // than its deadline of 3.25 ms.
  EXPECT_EQ(found[2].response_ns, 3'500'000);
}

TEST(CanResponse, CountsAFrameThatIsQueuedWithinABitOfTheStart) {
  std::vector<CanMessage> messages = davis_2007();
  for (CanMessage& message : messages) message.period_ns = message.deadline_ns = 100 * k_ms;
  messages[0].period_ns = 2 * k_ms + 4'000;  // A again, half a bit after C could have begun
  EXPECT_EQ(can_responses(messages, {.nominal = 125e3})[2].response_ns, 4 * k_ms);
  messages[0].period_ns = 2 * k_ms + 8'000;  // a whole bit after
  EXPECT_EQ(can_responses(messages, {.nominal = 125e3})[2].response_ns, 3 * k_ms);
}

TEST(CanResponse, AFifoDelaysAnUrgentFrameByAllThatMayStandBeforeIt) {
  std::vector<CanMessage> messages = davis_2007();
  for (CanMessage& message : messages) message.period_ns = message.deadline_ns = 20 * k_ms;
  messages[0].node = messages[1].node = messages[2].node = 7;
  const auto by_priority = can_responses(messages, {.nominal = 125e3});
  EXPECT_EQ(by_priority[0].response_ns, 2 * k_ms);  // one frame of any kind, then its own
  for (CanMessage& message : messages) message.fifo = true;
  const auto queued = can_responses(messages, {.nominal = 125e3});
  EXPECT_EQ(queued[0].response_ns, 3 * k_ms);
  EXPECT_EQ(queued[2].response_ns, 3 * k_ms);
  EXPECT_EQ(queued[0].queued_ns, 2 * k_ms);
}

// Its frames come twice as often as another node's may hold the bus: each once, a first in 3 ms.
TEST(CanResponse, AFifoThatFillsMostOfTheBusHasABound) {
  std::vector<CanMessage> messages = davis_2007();
  messages[0].period_ns = 20 * k_ms;
  messages[1].period_ns = 2'500'000;
  messages[2].period_ns = 3'500'000;
  messages[1].node = messages[2].node = 7;
  messages[1].fifo = messages[2].fifo = true;
  const auto found = can_responses(messages, {.nominal = 125e3});
  EXPECT_EQ(found[1].response_ns, 3 * k_ms);
  EXPECT_EQ(found[2].response_ns, 3 * k_ms);
  EXPECT_EQ(found[0].response_ns, 2 * k_ms);
}

TEST(CanResponse, AQueuesWaitIsJitterToOtherNodes) {
  std::vector<CanMessage> messages = davis_2007();
  for (CanMessage& message : messages) message.period_ns = message.deadline_ns = 20 * k_ms;
  messages.push_back(messages.back());
  messages[3].identifier = 9;
  messages[3].node = 3;
  messages[0].period_ns = 4 * k_ms;
  messages[0].node = messages[2].node = 7;
  messages[0].fifo = messages[2].fifo = true;
  const auto found = can_responses(messages, {.nominal = 125e3});
  EXPECT_GT(found[0].queued_ns, 0);
  auto apart = messages;
  apart[0].fifo = apart[2].fifo = false;
  EXPECT_GE(*found[3].response_ns, *can_responses(apart, {.nominal = 125e3})[3].response_ns);
}

TEST(CanResponse, OfAnFdFrameCountsBothBitRates) {
  std::vector<CanMessage> one(1);
  one[0].shape = {64, false, true, true};
  one[0].period_ns = 4 * k_ms;
  const CanFrameBits bits = worst_case_bits(one[0].shape);
  const auto found = can_responses(one, {.nominal = 500e3, .data = 2e6});
  EXPECT_NEAR(double(*found[0].response_ns), 1e9 * (bits.nominal / 500e3 + bits.data / 2e6), 1);
}

TEST(CanResponse, HasNoBoundOnAnOverloadedBus) {
  std::vector<CanMessage> messages = davis_2007();
  messages[0].period_ns = 1'500'000;
  EXPECT_GT(load_of(messages, {.nominal = 125e3}), 1);
  for (const CanResponse& found : can_responses(messages, {.nominal = 125e3})) {
    EXPECT_FALSE(found.response_ns);
  }
}

TEST(CanResponse, ShortIdentifiersWinAgainstLongOnesWithTheSameBeginning) {
  CanMessage shorter, longer;
  shorter.identifier = 0x123;
  longer.identifier = 0x123U << 18;
  longer.shape.extended = true;
  EXPECT_GT(urgency_of(shorter), urgency_of(longer));
  shorter.identifier = 0x124;
  EXPECT_LT(urgency_of(shorter), urgency_of(longer));
}

}  // namespace
}  // namespace glint::can_response_test
