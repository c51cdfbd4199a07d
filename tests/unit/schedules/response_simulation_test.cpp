// Response-time recurrence against an event simulation of random task sets.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <random>

#include "fixed_priority_simulator.hpp"
#include "schedules/response_time.hpp"
#include "tests/unit/repetitions.hpp"

namespace glint::response_simulation_test {
namespace {

const int k_task_sets = test::repetitions(1000, 100);
constexpr std::int64_t k_simulated_ns = 400'000;

std::vector<SimulatedTask> random_tasks(std::mt19937_64& random) {
  const auto between = [&](std::int64_t low, std::int64_t high) {
    return low + static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(high - low + 1));
  };
  std::vector<SimulatedTask> tasks(static_cast<std::size_t>(between(2, 6)));
  const double load = 0.3 + 0.65 * double(between(0, 1000)) / 1000;
  double shares = 0;
  std::vector<double> share(tasks.size());
  for (double& s : share) shares += s = 0.05 + double(between(0, 1000)) / 1000;
  for (std::size_t t = 0; t < tasks.size(); ++t) {
    tasks[t].period = between(100, 5000);
    tasks[t].jitter = between(0, 2) == 0 ? between(0, tasks[t].period / 2) : 0;
    tasks[t].cost = std::max<std::int64_t>(
        1, static_cast<std::int64_t>(load * share[t] / shares * double(tasks[t].period)));
  }
  // Lowest-priority work that can be preempted only between slices: it blocks all others.
  if (between(0, 1) == 0) tasks.back().slice = between(1, tasks.back().cost);
  return tasks;
}

std::optional<ResponseTime> bound_of(const std::vector<SimulatedTask>& tasks, std::size_t t) {
  std::vector<Interference> higher_priority;
  for (std::size_t u = 0; u < t; ++u) {
    higher_priority.push_back({tasks[u].cost, tasks[u].period, tasks[u].jitter});
  }
  const std::int64_t blocking = t + 1 < tasks.size() ? tasks.back().slice : 0;
  return response_time({tasks[t].cost, tasks[t].period, tasks[t].jitter, blocking},
                       higher_priority);
}

TEST(ResponseSimulation, NoResponseOfAThousandTaskSetsIsAboveItsBound) {
  std::mt19937_64 random(1993);
  int judged = 0, above = 0, reached = 0, unbounded = 0;
  std::vector<double> ratios;
  for (int set = 0; set < k_task_sets; ++set) {
    std::vector<SimulatedTask> tasks = random_tasks(random);
    std::vector<std::int64_t> worst(tasks.size(), 0);
    for (int run = 0; run < 4; ++run) {
      // First run, critical instant: all released together, the first with maximum jitter and then
      // on time; the lowest-priority task began its slice just before. Other runs: random phases,
      // jitter and costs.
      const bool critical = run == 0;
      for (SimulatedTask& task : tasks) {
        task.first = critical ? tasks.front().period - task.jitter
                              : static_cast<std::int64_t>(random() % 5000);
        if (critical && task.first < 0) task.first = 0;
      }
      if (critical) {
        const std::int64_t instant =
            std::max_element(tasks.begin(), tasks.end(),
                             [](const auto& a, const auto& b) { return a.jitter < b.jitter; })
                ->jitter +
            10'000;
        for (SimulatedTask& task : tasks) task.first = instant - task.jitter;
        if (tasks.back().slice > 0) --tasks.back().first;
      }
      const auto late = [&](std::size_t t, std::int64_t n) -> std::int64_t {
        if (critical) return n == 0 ? tasks[t].jitter : 0;
        return tasks[t].jitter == 0
                   ? 0
                   : static_cast<std::int64_t>(random() % std::uint64_t(tasks[t].jitter + 1));
      };
      const auto cost = [&](std::size_t t, std::int64_t) -> std::int64_t {
        if (critical || random() % 2 == 0) return tasks[t].cost;
        return 1 + static_cast<std::int64_t>(random() % std::uint64_t(tasks[t].cost));
      };
      const auto seen = simulate(tasks, k_simulated_ns, late, cost);
      for (std::size_t t = 0; t < tasks.size(); ++t) worst[t] = std::max(worst[t], seen[t]);
    }
    for (std::size_t t = 0; t < tasks.size(); ++t) {
      const auto bound = bound_of(tasks, t);
      if (!bound) {
        ++unbounded;
        continue;
      }
      ++judged;
      above += worst[t] > bound->response_ns ? 1 : 0;
      reached += worst[t] == bound->response_ns ? 1 : 0;
      if (worst[t] > 0) ratios.push_back(double(bound->response_ns) / double(worst[t]));
      EXPECT_LE(worst[t], bound->response_ns) << "set " << set << ", task " << t;
    }
  }
  std::sort(ratios.begin(), ratios.end());
  std::printf(
      "%d tasks of %d sets: %d above, %d reached, median bound/observed %.4f, %d unbounded\n",
      judged, k_task_sets, above, reached, ratios[ratios.size() / 2], unbounded);
  EXPECT_EQ(above, 0);
  EXPECT_EQ(unbounded, 0);
  // If the bound is rarely reached, the simulation does not cover the worst case.
  EXPECT_GT(reached, judged / 2);
}

}  // namespace
}  // namespace glint::response_simulation_test
