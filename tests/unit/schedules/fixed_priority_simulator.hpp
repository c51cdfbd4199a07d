// Event simulation of one core with preemptive fixed priorities, the reference for the
// response-time analysis and independent of it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <vector>

namespace glint {

struct SimulatedTask {
  std::int64_t cost = 0;
  std::int64_t period = 0;
  std::int64_t jitter = 0;  // maximum
  std::int64_t slice = 0;   // non-preemptive time from each start; 0: preemptive
  std::int64_t first = 0;   // nominal time of the first release
};

// `tasks` are in order of decreasing priority. `late(task, n)` is the jitter of release n
// (0..jitter), `cost(task, n)` its execution time. Returns each task's longest response from the
// nominal release, over all activations that end before `until`.
template <class Late, class Cost>
std::vector<std::int64_t> simulate(const std::vector<SimulatedTask>& tasks, std::int64_t until,
                                   Late late, Cost cost) {
  struct Job {
    std::int64_t nominal, left;
  };
  const std::size_t count = tasks.size();
  std::vector<std::deque<Job>> pending(count);
  std::vector<std::int64_t> number(count, 0), worst(count, 0);
  const auto nominal_of = [&](std::size_t t, std::int64_t n) {
    return tasks[t].first + n * tasks[t].period;
  };
  std::vector<std::int64_t> arrival(count);
  for (std::size_t t = 0; t < count; ++t) arrival[t] = nominal_of(t, 0) + late(t, 0);

  for (std::int64_t now = 0; now < until;) {
    for (std::size_t t = 0; t < count; ++t) {
      while (arrival[t] <= now) {
        pending[t].push_back({nominal_of(t, number[t]), cost(t, number[t])});
        ++number[t];
        // Releases of a task stay in order.
        arrival[t] = std::max(arrival[t], nominal_of(t, number[t]) + late(t, number[t]));
      }
    }
    const std::int64_t next = *std::min_element(arrival.begin(), arrival.end());
    std::size_t running = 0;
    while (running < count && pending[running].empty()) ++running;
    if (running == count) {
      now = next;
      continue;
    }
    Job& job = pending[running].front();
    // A started slice runs to its end; arrivals during it are queued afterwards.
    const std::int64_t slice = std::min(job.left, tasks[running].slice);
    const std::int64_t ran = std::max(slice, std::min(job.left, next - now));
    now += ran;
    job.left -= ran;
    if (job.left > 0) continue;
    worst[running] = std::max(worst[running], now - job.nominal);
    pending[running].pop_front();
  }
  return worst;
}

}  // namespace glint
