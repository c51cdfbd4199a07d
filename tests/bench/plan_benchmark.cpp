// Benchmark of a crowd of tools on two cores: the makespan that a schedule predicts from each
// node's execution time on its core, and the measured time of the planned executor. Exit 1: a limit
// is missed.
//
//   build/bench_plan [ROUNDS]
#include <sched.h>

#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <span>
#include <vector>

#include "dispatch_rows.hpp"
#include "handover.hpp"
#include "platform/budget/curve/crowd_kernel.hpp"
#include "platform/budget/task_model_of.hpp"
#include "platform/runtime/rt/cycle_clock.hpp"
#include "platform/runtime/rt/planned_executor.hpp"
#include "platform/runtime/session/run_schedule.hpp"
#include "platform/tools/report/statistics.hpp"
#include "rounds.hpp"
#include "schedules/exact_schedule.hpp"
#include "schedules/static_order.hpp"

namespace glint::bench {
namespace {

constexpr int k_rounds = 600;
constexpr DenseScenePoint k_crowd{k_tools_max, 20};
constexpr int k_cores = 2;
constexpr std::uint32_t k_spins_max = 100'000;

constexpr double k_makespan_ratio_max = 0.65;
constexpr double k_makespan_error_max = 0.15;

// Execution time of each node in the newest activation.
class NodeTimes {
 public:
  void on_node_begin(int /*node*/) noexcept { begin_ = cycle_count(); }
  void on_node_end(int node) noexcept {
    ns_[static_cast<std::size_t>(node)] =
        static_cast<double>(cycle_count() - begin_) * ns_per_cycle();
  }
  [[nodiscard]] double of(int node) const { return ns_[static_cast<std::size_t>(node)]; }

 private:
  std::uint64_t begin_ = 0;
  std::array<double, static_cast<std::size_t>(Tracker::node_count)> ns_{};
};

template <class Activate>
double microseconds_of(Activate activate) {
  const std::uint64_t begin = cycle_count();
  activate();
  return static_cast<double>(cycle_count() - begin) * ns_per_cycle() * 1e-3;
}

// The frame group with `ns_of(node)` instead of the bounds.
template <class Times>
TaskGroup group_of(const Times& ns_of) {
  TaskGroup group = task_structure_of(crowd_cell(k_crowd.tools)).groups[k_frame_group_index];
  for (int node = 0; node < Tracker::node_count; ++node) {
    group.nodes[static_cast<std::size_t>(node)].bound_ns = static_cast<std::int64_t>(ns_of(node));
  }
  return group;
}

using Medians = std::array<double, static_cast<std::size_t>(Tracker::node_count)>;

// Median execution time of each node on this core.
Medians medians_on(int core, DenseSceneKernel& crowd, int rounds) {
  std::vector<std::vector<double>> ns(static_cast<std::size_t>(Tracker::node_count));
  {
    const RealTimeThread thread({"bench", core, k_frame_priority}, [&] {
      for (int round = 0; round < rounds; ++round) {
        NodeTimes times;
        crowd.set_frame(static_cast<std::uint64_t>(round));
        crowd.tracker().activate(times);
        for (int node = 0; node < Tracker::node_count; ++node) {
          ns[static_cast<std::size_t>(node)].push_back(times.of(node));
        }
      }
    });
  }
  Medians medians;
  for (std::size_t node = 0; node < ns.size(); ++node) medians[node] = percentile(ns[node], 0.5);
  return medians;
}

// Ratio of each node's time on its core to its time on core 0. On a shared machine, other load may
// slow one core only.
Medians core_time_ratios(const graph::ScheduleTables<Tracker>& tables, DenseSceneKernel& crowd,
                         int rounds) {
  const Medians first = medians_on(0, crowd, rounds), second = medians_on(1, crowd, rounds);
  Medians factor;
  factor.fill(1);
  for (int i = 0; i < tables.count[1]; ++i) {
    const auto node = static_cast<std::size_t>(tables.order[1][static_cast<std::size_t>(i)]);
    factor[node] = first[node] > 0 ? second[node] / first[node] : 1;
  }
  return factor;
}

graph::ScheduleTables<Tracker> tables_of(const CoreOrders& orders) {
  // Worker 0 must start with the graph's first node.
  graph::ScheduleTables<Tracker> tables;
  tables.workers = k_cores;
  const bool first = !orders[0].empty() && orders[0][0] == 0;
  for (int worker = 0; worker < k_cores; ++worker) {
    const auto core = static_cast<std::size_t>(first ? worker : k_cores - 1 - worker);
    for (const int node : orders[core]) (void)tables.add(node, worker);
  }
  return tables;
}

// Keeps a core out of its idle states, whose wake-up latency exceeds the execution time of the
// nodes; a real-time computer disables them. Every other thread has priority over it.
class IdleSpinner {
 public:
  explicit IdleSpinner(int core)
      : thread_({"awake", core, 0}, [this] {
          const sched_param least{};
          (void)sched_setscheduler(0, SCHED_IDLE, &least);
          const WorkerWaitPolicy rest({}, 0);
          while (!stop_.load(std::memory_order_relaxed)) rest.spin();
        }) {}
  ~IdleSpinner() { stop_.store(true, std::memory_order_relaxed); }
  IdleSpinner(const IdleSpinner&) = delete;
  IdleSpinner& operator=(const IdleSpinner&) = delete;

 private:
  std::atomic<bool> stop_{false};
  RealTimeThread thread_;  // the last member: joined first
};

bool run(int rounds) {
  apply_settings({"bench", 0, k_frame_priority});
  const std::vector<ThreadSettings> others{{"bench 2", 1, k_frame_priority}};
  DenseSceneKernel crowd(k_crowd);
  const Medians typical = medians_on(0, crowd, rounds);
  const TaskGroup group =
      group_of([&](int node) { return typical[static_cast<std::size_t>(node)]; });
  const std::int64_t inter_core_delay_ns = measured_core_delay_ns(0, 1);
  const IdleSpinner spinner(1);
  const ExactSchedule plan = exact_schedule(group, k_cores, inter_core_delay_ns);
  const graph::ScheduleTables<Tracker> tables = tables_of(plan.orders);
  const Medians slower = core_time_ratios(tables, crowd, rounds);
  PlannedExecutor<Tracker> executor(tables, others, k_spins_max);

  // Each round predicts the makespan from the nodes' times on one core in the same round, so that a
  // slow machine slows both alike.
  std::vector<double> one_us, plan_us, two_us, beside;
  for (int round = 0; round < rounds; ++round) {
    const auto frame = static_cast<std::uint64_t>(round);
    NodeTimes times;
    crowd.set_frame(frame);
    one_us.push_back(microseconds_of([&] { crowd.tracker().activate(times); }));
    const TaskGroup now =
        group_of([&](int node) { return times.of(node) * slower[static_cast<std::size_t>(node)]; });
    plan_us.push_back(
        static_cast<double>(times_of(now, plan.orders, inter_core_delay_ns)->makespan_ns) * 1e-3);
    crowd.set_frame(frame);
    two_us.push_back(microseconds_of([&] {
      std::array<graph::NoTrace, k_cores> untraced;
      graph::NoBoundary always;
      (void)executor.execute(crowd.tracker(), std::span<graph::NoTrace>(untraced), always);
      executor.finish_activation(crowd.tracker());
    }));
    beside.push_back(two_us.back() / plan_us.back() - 1);
  }

  const double one = percentile(one_us, 0.5), planned = percentile(plan_us, 0.5);
  print_machine();
  std::printf("%d tools, %d strays, %d rounds; a hand-over takes %lld ns; the plan is %s\n",
              k_crowd.tools, k_crowd.strays, rounds, static_cast<long long>(inter_core_delay_ns),
              plan.optimal ? "optimal" : "not proven optimal");
  std::printf("one core    observed median %8.1f us\n", one);
  std::printf("two cores   planned         %8.1f us   observed median %8.1f us\n", planned,
              percentile(two_us, 0.5));
  bool met = print_bar("plan / one core", planned / one, "", k_makespan_ratio_max, true);
  met &= print_bar("observed beside the plan, median of the rounds",
                   std::abs(percentile(beside, 0.5)), "", k_makespan_error_max, true);
  return met;
}

}  // namespace
}  // namespace glint::bench

int main(int argc, char** argv) {
  const auto rounds = glint::bench::rounds_of(argc, argv, glint::bench::k_rounds, 100);
  if (!rounds) return 2;
  return glint::bench::run(*rounds) ? 0 : 1;
}
