#include "schedules/can_response.hpp"

#include <gtest/gtest.h>

#include <array>
#include <random>
#include <string>

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
  // C's first frame takes 3 ms, where the original analysis stopped. Its second one exceeds its
  // deadline of 3.25 ms.
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
  const auto analyse_priority_queue = can_responses(messages, {.nominal = 125e3});
  EXPECT_EQ(analyse_priority_queue[0].response_ns,
            2 * k_ms);  // one frame of any priority, then its own
  for (CanMessage& message : messages) message.fifo = true;
  const auto queued = can_responses(messages, {.nominal = 125e3});
  EXPECT_EQ(queued[0].response_ns, 3 * k_ms);
  EXPECT_EQ(queued[2].response_ns, 3 * k_ms);
  EXPECT_EQ(queued[0].queued_ns, 2 * k_ms);
}

// The FIFO has 69 % load. Each message is sent at most once before a frame ends, within 3 ms.
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

// At 125 kbit/s a frame takes 1 ms, a bit 8 us. All frames of a FIFO have the priority of B, its
// lowest. C blocks; D precedes both at every release.
TEST(CanResponse, OfAQueueCountsWhatIsMoreUrgentThanItsLeastUrgentFrame) {
  std::vector<CanMessage> messages = davis_2007();
  messages.push_back(messages[0]);
  const std::uint32_t identifier[] = {1, 5, 9, 3};
  for (std::size_t m = 0; m < 4; ++m) {
    messages[m].identifier = identifier[m];
    messages[m].period_ns = messages[m].deadline_ns = 20 * k_ms;
    messages[m].fifo = m < 2;
    messages[m].node = m < 2 ? 7 : static_cast<int>(m);
  }
  const auto found = [&](std::int64_t gap_of_d, std::int64_t jitter_of_a) {
    messages[3].period_ns = gap_of_d;
    messages[0].jitter_ns = jitter_of_a;
    return can_responses(messages, {.nominal = 125e3});
  };
  for (const std::size_t m : {0U, 1U}) {
    // C, D, the other frame of the queue, its own; with D every 3 ms, D again.
    EXPECT_EQ(found(4 * k_ms, 0)[m].response_ns, 4 * k_ms) << m;
    EXPECT_EQ(found(3 * k_ms, 0)[m].response_ns, 5 * k_ms) << m;
    EXPECT_EQ(found(3 * k_ms, 0)[m].queued_ns, 4 * k_ms) << m;
    EXPECT_EQ(found(4 * k_ms, 2 * k_ms)[m].response_ns, (m == 0 ? 6 : 4) * k_ms) << "its own";
  }
  // D waits for one frame that began, and for A once. A's queueing delay behind B is jitter to D.
  EXPECT_EQ(found(20 * k_ms, 0)[3].response_ns, 3 * k_ms);
  EXPECT_EQ(found(20 * k_ms, 0)[3].queued_ns, 0);
}

TEST(CanResponse, OfAFrameThatIsAloneIsItsLength) {
  std::vector<CanMessage> one(1, davis_2007()[0]);
  for (const bool fifo : {false, true}) {
    one[0].fifo = fifo;
    const auto found = can_responses(one, {.nominal = 125e3});
    EXPECT_EQ(found[0].response_ns, 1 * k_ms) << fifo;
    EXPECT_EQ(found[0].queued_ns, 0) << fifo;
  }
}

TEST(CanResponse, AQueuesWaitBringsItsFramesCloserTogether) {
  std::vector<CanMessage> messages = davis_2007();
  for (CanMessage& message : messages) message.period_ns = message.deadline_ns = 20 * k_ms;
  messages[0].period_ns = 5 * k_ms;
  messages[0].node = messages[1].node = 7;
  messages[0].fifo = messages[1].fifo = true;
  // Each queued frame waits for one of C and for the other of the queue: 2 ms. C begins after 2 ms;
  // A is released again after 5 - 2 ms at the earliest, or after 2 ms with a period of 4 ms.
  auto found = can_responses(messages, {.nominal = 125e3});
  EXPECT_EQ(found[0].queued_ns, 2 * k_ms);
  EXPECT_EQ(found[2].response_ns, 3 * k_ms);
  messages[0].period_ns = 4 * k_ms;
  found = can_responses(messages, {.nominal = 125e3});
  EXPECT_EQ(found[0].queued_ns, 2 * k_ms);
  EXPECT_EQ(found[2].response_ns, 4 * k_ms) << "a second A within the bit after which C begins";
}

// Two nodes share an identifier: the arbitration is undefined, so each may delay the other.
TEST(CanResponse, AnIdentifierThatTwoNodesUseDelaysEither) {
  std::vector<CanMessage> messages = davis_2007();
  for (CanMessage& message : messages) {
    message.period_ns = message.deadline_ns = 20 * k_ms;
    message.identifier = 4;
  }
  for (const CanResponse& found : can_responses(messages, {.nominal = 125e3})) {
    EXPECT_EQ(found.response_ns, 3 * k_ms);
  }
}

TEST(CanResponse, AddsAFramesJitterToItsOwnResponseAndItsReleasesToOthers) {
  std::vector<CanMessage> messages = davis_2007();
  for (CanMessage& message : messages) message.period_ns = message.deadline_ns = 20 * k_ms;
  messages[0].jitter_ns = 19 * k_ms;
  const auto found = can_responses(messages, {.nominal = 125e3});
  EXPECT_EQ(found[0].response_ns, 19 * k_ms + 2 * k_ms);
  EXPECT_EQ(found[1].response_ns, 4 * k_ms) << "A twice, one of C, its own";
}

TEST(CanResponse, TakesAStatedLengthInPlaceOfTheShapes) {
  std::vector<CanMessage> messages = davis_2007();
  for (CanMessage& message : messages) message.period_ns = message.deadline_ns = 20 * k_ms;
  messages[1].frame_ns = 300'000;
  const auto found = can_responses(messages, {.nominal = 125e3});
  EXPECT_EQ(found[1].frame_ns, 300'000);
  EXPECT_EQ(found[1].response_ns, 2'300'000);
  EXPECT_EQ(found[2].response_ns, 2'300'000);
  EXPECT_DOUBLE_EQ(load_of(messages, {.nominal = 125e3}), (1 + 0.3 + 1) / 20);
}

TEST(CanResponse, HasABoundAtFullLoad) {
  std::vector<CanMessage> messages = davis_2007();
  messages.pop_back();
  for (CanMessage& message : messages) message.period_ns = message.deadline_ns = 2 * k_ms;
  EXPECT_EQ(load_of(messages, {.nominal = 125e3}), 1);
  const auto found = can_responses(messages, {.nominal = 125e3});
  EXPECT_EQ(found[0].response_ns, 2 * k_ms);
  EXPECT_EQ(found[1].response_ns, 2 * k_ms);
  messages[1].period_ns -= 1'000;
  const auto none = can_responses(messages, {.nominal = 125e3});
  EXPECT_FALSE(none[0].response_ns || none[1].response_ns);
  EXPECT_EQ(none[1].frame_ns, 1 * k_ms) << "its length is stated all the same";
}

// One frame occupies the bus for longer than the longest busy period that the analysis examines.
TEST(CanResponse, OfNoFrameIsBoundedWhereOneHasNoBound) {
  for (const bool fifo : {false, true}) {
    std::vector<CanMessage> messages = davis_2007();
    for (CanMessage& message : messages) message.period_ns = 1'000'000 * k_ms;
    messages[0].frame_ns = 101'000 * k_ms;
    messages[0].fifo = fifo;
    const auto found = can_responses(messages, {.nominal = 125e3});
    ASSERT_EQ(found.size(), 3U);
    for (const CanResponse& each : found) EXPECT_FALSE(each.response_ns);
    EXPECT_EQ(found[0].frame_ns, 101'000 * k_ms);
    EXPECT_EQ(found[2].frame_ns, 1 * k_ms);
  }
  // The last message's releases may all come at once; without it the others have a bound.
  for (const bool fifo : {false, true}) {
    std::vector<CanMessage> messages = davis_2007();
    for (CanMessage& message : messages) message.period_ns = 20 * k_ms;
    messages[2].fifo = fifo;
    ASSERT_TRUE(can_responses(messages, {.nominal = 125e3})[0].response_ns);
    messages[2].jitter_ns = 1'000'000'000 * k_ms;
    const auto found = can_responses(messages, {.nominal = 125e3});
    ASSERT_EQ(found.size(), 3U);
    for (const CanResponse& each : found) EXPECT_FALSE(each.response_ns) << fifo;
  }
  EXPECT_TRUE(can_responses({}, {}).empty());
}

// Arbitration fields without SOF and stuff bits: the first differing bit decides, and 0 wins.
TEST(CanResponse, OrdersIdentifiersAsArbitrationDoes) {
  std::mt19937 random(11898);
  const auto on_the_bus = [](const CanMessage& message) {
    const bool extended = message.shape.extended;
    std::string bits;
    const auto append = [&](std::uint32_t value, int width) {
      for (int i = width; i-- > 0;) bits += (value >> i & 1U) != 0 ? '1' : '0';
    };
    append(extended ? message.identifier >> 18 : message.identifier, 11);
    append(extended ? 3 : 0, 2);  // SRR and IDE; RTR and IDE
    if (extended) append(message.identifier & 0x3FFFF, 18);
    return bits;
  };
  for (int i = 0; i < 2'000; ++i) {
    std::array<CanMessage, 2> pair;
    const std::uint32_t base = random() % 4;
    for (CanMessage& message : pair) {
      message.shape.extended = random() % 2 == 0;
      const std::uint32_t high = 0x7F0 + base + random() % 2;
      message.identifier =
          message.shape.extended ? high << 18 | random() % 4 << 16 | random() % 3 : high;
    }
    const std::string a = on_the_bus(pair[0]), b = on_the_bus(pair[1]);
    EXPECT_EQ(arbitration_priority(pair[0]) > arbitration_priority(pair[1]), a < b)
        << a << ' ' << b;
    EXPECT_EQ(arbitration_priority(pair[0]) == arbitration_priority(pair[1]), a == b)
        << a << ' ' << b;
  }
}

TEST(CanResponse, ShortIdentifiersWinAgainstLongOnesWithTheSameBeginning) {
  CanMessage shorter, longer;
  shorter.identifier = 0x123;
  longer.identifier = 0x123U << 18;
  longer.shape.extended = true;
  EXPECT_GT(arbitration_priority(shorter), arbitration_priority(longer));
  shorter.identifier = 0x124;
  EXPECT_LT(arbitration_priority(shorter), arbitration_priority(longer));
}

}  // namespace
}  // namespace glint::can_response_test
