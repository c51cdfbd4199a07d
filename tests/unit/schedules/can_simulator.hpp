// CAN bus simulation, frame by frame: nodes with priority or FIFO queues, and arbitration among the
// heads of the queues. Independent of the analysis.
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <map>
#include <vector>

#include "schedules/can_response.hpp"

namespace glint {

// `first[m]` is message m's first nominal release, `late(m, n)` the jitter of its release n,
// `length(m, n)` the duration of a frame. Returns each message's longest response from its nominal
// release.
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
      // In order of arrival; simultaneous arrivals in the order of the list.
      const auto next = std::min_element(arrival.begin(), arrival.end());
      if (*next > now) return;
      const auto m = static_cast<std::size_t>(next - arrival.begin());
      const std::int64_t nominal = first[m] + number[m] * messages[m].period_ns;
      queues[messages[m].node].push_back({m, nominal, number[m]});
      ++number[m];
      *next = std::max(*next, first[m] + number[m] * messages[m].period_ns + late(m, number[m]));
    }
  };
  const auto higher_priority = [&](const Queued& a, const Queued& b) {
    return arbitration_priority(messages[a.message]) > arbitration_priority(messages[b.message]);
  };

  for (std::int64_t now = 0; now < until;) {
    let_in(now);
    std::deque<Queued>* winner = nullptr;
    typename std::deque<Queued>::iterator offered_by_winner;
    for (auto& [node, queue] : queues) {
      if (queue.empty()) continue;
      auto offered = queue.begin();
      if (!messages[offered->message].fifo) {
        // Highest priority; of equal identifiers the oldest.
        for (auto other = queue.begin(); other != queue.end(); ++other) {
          if (higher_priority(*other, *offered)) offered = other;
        }
      }
      if (winner != nullptr && !higher_priority(*offered, *offered_by_winner)) continue;
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
