// What two cores give a crowd of tools: the makespan that a plan foretells from each node's time on
// one core, and what the planned executor then takes. Exit 1: a bar is missed.
//
//   build/bench_plan [ROUNDS]
#include <algorithm>
#include <array>
#include <cstdio>
#include <span>
#include <string>
#include <vector>

#include "dispatch_rows.hpp"
#include "handover.hpp"
#include "platform/budget/curve/crowd_kernel.hpp"
#include "platform/budget/task_model_of.hpp"
#include "platform/report/statistics.hpp"
#include "platform/rt/cycle_clock.hpp"
#include "platform/rt/planned_executor.hpp"
#include "rounds.hpp"
#include "schedules/exact_schedule.hpp"
#include "schedules/static_order.hpp"

namespace glint::bench {
namespace {

constexpr int k_rounds = 600;
constexpr CrowdPoint k_crowd{k_tools_max, 20};
constexpr int k_cores = 2;
constexpr std::uint32_t k_spins_max = 100'000;

constexpr double k_plan_part_most = 0.65;
constexpr double k_beside_plan_most = 0.15;

class NodeTimes {
 public:
  void on_node_begin(int /*node*/) noexcept { begin_ = cycle_count(); }
  void on_node_end(int node) noexcept {
    ns_[static_cast<std::size_t>(node)].push_back(static_cast<double>(cycle_count() - begin_) *
                                                  ns_per_cycle());
  }
  [[nodiscard]] double median(int node) const {
    return percentile(ns_[static_cast<std::size_t>(node)], 0.5);
  }

 private:
  std::uint64_t begin_ = 0;
  std::array<std::vector<double>, static_cast<std::size_t>(Tracker::node_count)> ns_;
};

template <class Activate>
double microseconds_of(Activate activate) {
  const std::uint64_t begin = cycle_count();
  activate();
  return static_cast<double>(cycle_count() - begin) * ns_per_cycle() * 1e-3;
}

// The frame group with each node's median on one core in its bound's place.
TaskGroup typical_group(CrowdKernel& crowd, int rounds) {
  NodeTimes times;
  for (int round = 0; round < rounds; ++round) {
    crowd.show(static_cast<std::uint64_t>(round));
    crowd.tracker().activate(times);
  }
  TaskGroup group = task_structure_of(crowd_cell(k_crowd.tools)).groups[k_frame_group_index];
  for (int node = 0; node < Tracker::node_count; ++node) {
    group.nodes[static_cast<std::size_t>(node)].bound_ns =
        static_cast<std::int64_t>(times.median(node));
  }
  return group;
}

graph::PlanTables<Tracker> tables_of(const CoreOrders& orders) {
  // Worker 0 begins with the graph's first node.
  graph::PlanTables<Tracker> tables;
  tables.workers = k_cores;
  const bool first = !orders[0].empty() && orders[0][0] == 0;
  for (int worker = 0; worker < k_cores; ++worker) {
    const auto core = static_cast<std::size_t>(first ? worker : k_cores - 1 - worker);
    for (const int node : orders[core]) (void)tables.add(node, worker);
  }
  return tables;
}

bool run(int rounds) {
  become({"bench", 0, 0});
  const std::vector<ThreadSettings> others{{"bench 2", 1, 0}};
  CrowdKernel crowd(k_crowd);
  const TaskGroup group = typical_group(crowd, rounds);
  const std::int64_t handover_ns = measured_handover_ns(0, 1);
  const ExactSchedule plan = exact_schedule(group, k_cores, handover_ns);
  PlannedExecutor<Tracker> executor(tables_of(plan.orders), others, k_spins_max);

  // One after the other, so that whatever slows the machine slows both.
  std::vector<double> one_us, two_us;
  for (int round = 0; round < rounds; ++round) {
    const auto frame = static_cast<std::uint64_t>(round);
    crowd.show(frame);
    one_us.push_back(microseconds_of([&] { crowd.tracker().activate(); }));
    crowd.show(frame);
    two_us.push_back(microseconds_of([&] {
      std::array<graph::NoTrace, k_cores> untraced;
      graph::NoBoundary always;
      (void)executor.execute(crowd.tracker(), std::span<graph::NoTrace>(untraced), always);
      executor.settle(crowd.tracker());
    }));
  }

  double sum_us = 0;
  for (const TaskNode& node : group.nodes) sum_us += static_cast<double>(node.bound_ns) * 1e-3;
  const double planned_us = static_cast<double>(plan.makespan_ns) * 1e-3;
  const double one = percentile(one_us, 0.5), two = percentile(two_us, 0.5);
  print_machine();
  std::printf("%d tools, %d strays, %d rounds; a hand-over takes %lld ns\n", k_crowd.tools,
              k_crowd.strays, rounds, static_cast<long long>(handover_ns));
  std::printf("one core   sum of the nodes' medians %8.1f us   observed median %8.1f us\n", sum_us,
              one);
  std::printf("two cores  makespan of the plan      %8.1f us   observed median %8.1f us   %s\n",
              planned_us, two, plan.optimal ? "optimal" : "optimum not proven");
  bool met = print_bar("plan / one core", planned_us / sum_us, "", k_plan_part_most, true);
  met &= print_bar("observed beside the plan", std::abs(two / planned_us - 1), "",
                   k_beside_plan_most, true);
  return met;
}

}  // namespace
}  // namespace glint::bench

int main(int argc, char** argv) {
  const auto rounds = glint::bench::rounds_of(argc, argv, glint::bench::k_rounds, 100);
  if (!rounds) return 2;
  return glint::bench::run(*rounds) ? 0 : 1;
}
