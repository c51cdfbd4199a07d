// Worst-case CAN response times against simulated random message sets; one node has a FIFO.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <random>

#include "can_simulator.hpp"
#include "schedules/can_response.hpp"
#include "tests/unit/repetitions.hpp"

namespace glint::can_simulation_test {
namespace {

const int k_message_sets = test::repetitions(1000, 100);
constexpr std::int64_t k_simulated_ns = 400'000'000;
constexpr CanBitRates k_rates{.nominal = 500e3, .data = 2e6};

std::vector<CanMessage> random_messages(std::mt19937_64& random) {
  const auto between = [&](std::int64_t low, std::int64_t high) {
    return low + static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(high - low + 1));
  };
  std::vector<CanMessage> messages(static_cast<std::size_t>(between(3, 12)));
  const double load = 0.2 + 0.7 * double(between(0, 1000)) / 1000;
  const int nodes = static_cast<int>(between(2, 4));
  for (std::size_t m = 0; m < messages.size(); ++m) {
    CanMessage& message = messages[m];
    message.identifier = static_cast<std::uint32_t>(100 * m + std::size_t(between(0, 99)));
    message.node = static_cast<int>(between(0, nodes - 1));
    message.fifo = message.node == 0;
    message.shape.fd = between(0, 3) == 0;
    message.shape.bit_rate_switch = message.shape.fd;
    message.shape.data_bytes = static_cast<int>(message.shape.fd ? 64 : between(0, 8));
    const double frame = 1e9 * worst_case_seconds(message.shape, k_rates);
    const double factor = 0.4 + 1.2 * double(between(0, 1000)) / 1000;
    message.period_ns = static_cast<std::int64_t>(frame * double(messages.size()) / load * factor);
    message.jitter_ns = between(0, 2) == 0 ? between(0, message.period_ns / 2) : 0;
    message.deadline_ns = message.period_ns;
  }
  return messages;
}

TEST(CanSimulation, NoResponseOfAThousandMessageSetsIsAboveItsBound) {
  std::mt19937_64 random(2007);
  int judged = 0, above = 0, reached = 0, near_bound = 0, unbounded = 0, with_fifo = 0;
  std::vector<double> ratios;
  for (int set = 0; set < k_message_sets;) {
    const std::vector<CanMessage> messages = random_messages(random);
    const std::vector<CanResponse> bounds = can_responses(messages, k_rates);
    if (!bounds.front().response_ns) {
      ++unbounded;
      continue;
    }
    ++set;
    std::vector<std::int64_t> worst(messages.size(), 0);
    for (int run = 0; run < 6; ++run) {
      // Half of the runs start at the critical instant: all frames together with maximum jitter,
      // just after one of the longest frames began.
      const bool together = run % 2 == 0;
      std::vector<std::int64_t> first(messages.size());
      const std::size_t early = random() % messages.size();
      for (std::size_t m = 0; m < messages.size(); ++m) {
        first[m] = together ? 500'000'000 - messages[m].jitter_ns - (m == early ? 1 : 0)
                            : static_cast<std::int64_t>(random() % 20'000'000);
      }
      const std::int64_t until = k_simulated_ns + (together ? 500'000'000 : 0);
      const auto late = [&](std::size_t m, std::int64_t n) -> std::int64_t {
        if (together) return n == 0 ? messages[m].jitter_ns : 0;
        return static_cast<std::int64_t>(random() % std::uint64_t(messages[m].jitter_ns + 1));
      };
      const auto length = [&](std::size_t m, std::int64_t) -> std::int64_t {
        if (together || random() % 2 == 0) return bounds[m].frame_ns;
        return bounds[m].frame_ns * 3 / 4;  // fewer stuff bits
      };
      const auto seen = simulate_bus(messages, first, until, late, length);
      for (std::size_t m = 0; m < messages.size(); ++m) worst[m] = std::max(worst[m], seen[m]);
    }
    for (std::size_t m = 0; m < messages.size(); ++m) {
      ++judged;
      with_fifo += messages[m].fifo ? 1 : 0;
      above += worst[m] > *bounds[m].response_ns ? 1 : 0;
      // The blocking frame began a nanosecond earlier.
      reached += worst[m] >= *bounds[m].response_ns - 1 ? 1 : 0;
      near_bound += double(worst[m]) >= 0.9 * double(*bounds[m].response_ns) ? 1 : 0;
      ratios.push_back(double(*bounds[m].response_ns) / double(worst[m]));
      EXPECT_LE(worst[m], *bounds[m].response_ns) << "set " << set << ", message " << m;
    }
  }
  std::sort(ratios.begin(), ratios.end());
  std::printf(
      "%d frames (%d in queues) of %d sets: %d above, %d reached, %d within 10 %%, median "
      "bound/observed %.4f, %d more without a bound\n",
      judged, with_fifo, k_message_sets, above, reached, near_bound, ratios[ratios.size() / 2],
      unbounded);
  EXPECT_EQ(above, 0);
  EXPECT_LT(unbounded, k_message_sets / 5);
  EXPECT_GT(reached, judged / 10);
  EXPECT_GT(near_bound, judged / 4);
}

}  // namespace
}  // namespace glint::can_simulation_test
