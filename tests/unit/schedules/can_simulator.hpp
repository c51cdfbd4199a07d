// A CAN bus, frame by frame: nodes with priority queues or first-in first-out queues, arbitration
// among what they offer. It knows no formula.
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <map>
#include <vector>

#include "schedules/can_response.hpp"

namespace glint {

// `first[m]` is frame m's first nominal release; `late(m, n)` its lateness (0..jitter); frames take
// `length(m, n)`. Gives each frame's longest response from its nominal release.
template <class Late, class Length>
std::vector<std::int64_t> simulate_bus(const std::vector<CanMessage>& messages,
                                       const std::vector<std::int64_t>& first, std::int64_t until,
                                       Late late, Length length) {
  struct Queued {
    std::size_t message;
    std::int64_t nominal, number;
  };
  const std::size_t count = messages.size();
  std::vector<std::int64_t> number(count, 0), arrival(count), worst(count, 0);
  std::map<int, std::deque<Queued>> queues;
  for (std::size_t m = 0; m < count; ++m) arrival[m] = first[m] + late(m, 0);

  const auto let_in = [&](std::int64_t now) {
    for (;;) {
      // In the order of arrival; of those that come together, as they stand.
      const auto next = std::min_element(arrival.begin(), arrival.end());
      if (*next > now) return;
      const auto m = static_cast<std::size_t>(next - arrival.begin());
      const std::int64_t nominal = first[m] + number[m] * messages[m].period_ns;
      queues[messages[m].node].push_back({m, nominal, number[m]});
      ++number[m];
      *next = std::max(*next, first[m] + number[m] * messages[m].period_ns + late(m, number[m]));
    }
  };
  const auto more_urgent = [&](const Queued& a, const Queued& b) {
    return urgency_of(messages[a.message]) > urgency_of(messages[b.message]);
  };

  for (std::int64_t now = 0; now < until;) {
    let_in(now);
    std::deque<Queued>* winner = nullptr;
    typename std::deque<Queued>::iterator offered_by_winner;
    for (auto& [node, queue] : queues) {
      if (queue.empty()) continue;
      auto offered = queue.begin();
      if (!messages[offered->message].fifo) {
        // The most urgent; of one identifier the oldest.
        for (auto other = queue.begin(); other != queue.end(); ++other) {
          if (more_urgent(*other, *offered)) offered = other;
        }
      }
      if (winner != nullptr && !more_urgent(*offered, *offered_by_winner)) continue;
      winner = &queue;
      offered_by_winner = offered;
    }
    if (winner == nullptr) {
      now = *std::min_element(arrival.begin(), arrival.end());
      continue;
    }
    const Queued sent = *offered_by_winner;
    winner->erase(offered_by_winner);
    now += length(sent.message, sent.number);
    worst[sent.message] = std::max(worst[sent.message], now - sent.nominal);
  }
  return worst;
}

}  // namespace glint
