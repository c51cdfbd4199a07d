#include "schedules/synthesis.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <utility>

#include "schedules/group_response.hpp"
#include "schedules/static_order.hpp"

namespace glint {
namespace {

using Placement = std::vector<CoreOrders>;  // by group

// Moves the group's first node to core 0, where the released worker runs.
CoreOrders first_node_first(CoreOrders orders) {
  for (CoreOrders::iterator core = orders.begin(); core != orders.end(); ++core) {
    if (std::find(core->begin(), core->end(), 0) != core->end()) {
      std::iter_swap(orders.begin(), core);
      break;
    }
  }
  return orders;
}

bool on_one_core(const CoreOrders& orders) {
  return std::count_if(orders.begin(), orders.end(), [](const auto& o) { return !o.empty(); }) <= 1;
}

Plan schedule_of(const TaskModel& model, const Placement& placement) {
  Plan plan;
  plan.cores = model.cores;
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    const TaskGroup& group = model.groups[g];
    const auto times = times_of(group, placement[g], model.system.inter_core_delay_ns);
    plan.groups.push_back({group.name, group.priority, times->makespan_ns, 0, false});
    for (std::size_t core = 0; core < placement[g].size(); ++core) {
      for (const int node : placement[g][core]) {
        const auto n = static_cast<std::size_t>(node);
        plan.nodes.push_back({static_cast<int>(g), node, static_cast<int>(core), times->start_ns[n],
                              times->end_ns[n]});
      }
    }
  }
  return plan;
}

void assign_priorities(const TaskModel& model, Plan& plan) {
  const std::size_t count = plan.groups.size();
  std::vector<std::size_t> unassigned;
  for (std::size_t g = 0; g < count; ++g) unassigned.push_back(g);
  std::stable_sort(unassigned.begin(), unassigned.end(), [&](std::size_t a, std::size_t b) {
    const TaskGroup &first = model.groups[a], &second = model.groups[b];
    if (first.resumable != second.resumable) return second.resumable;
    return first.deadline_ns < second.deadline_ns;
  });
  // Groups without a final priority are deadline monotonic.
  const auto number = [&] {
    for (std::size_t rank = 0; rank < unassigned.size(); ++rank) {
      plan.groups[unassigned[rank]].priority =
          k_priority_max - k_priority_step * static_cast<int>(rank);
    }
  };
  while (!unassigned.empty()) {
    number();
    const std::vector<std::size_t> by_deadline = unassigned;
    const int lowest = plan.groups[unassigned.back()].priority;
    std::size_t chosen = unassigned.size() - 1;
    for (std::size_t candidate = unassigned.size(); candidate-- > 0;) {
      if (model.groups[unassigned.back()].resumable !=
          model.groups[unassigned[candidate]].resumable)
        break;
      unassigned = by_deadline;
      std::rotate(unassigned.begin() + static_cast<std::ptrdiff_t>(candidate),
                  unassigned.begin() + static_cast<std::ptrdiff_t>(candidate) + 1,
                  unassigned.end());
      number();
      if (!group_responses(model, plan)[unassigned.back()].meets_deadline()) continue;
      chosen = candidate;
      break;
    }
    unassigned = by_deadline;
    plan.groups[unassigned[chosen]].priority = lowest;
    unassigned.erase(unassigned.begin() + static_cast<std::ptrdiff_t>(chosen));
  }
}

// Response over deadline of every group, in decreasing order; a missing bound is the maximum.
std::vector<double> tightness(const TaskModel& model, const Plan& plan) {
  std::vector<double> shares;
  for (const GroupResponse& group : group_responses(model, plan)) {
    if (!group.response_ns) return {std::numeric_limits<double>::max()};
    shares.push_back(double(*group.response_ns) /
                     double(std::max<std::int64_t>(group.deadline_ns, 1)));
  }
  std::sort(shares.begin(), shares.end(), std::greater<>());
  return shares;
}

}  // namespace

Plan synthesize(const TaskModel& model, std::int64_t search_nodes_max) {
  Placement shortest;
  std::vector<ExactSchedule> found;
  std::vector<std::size_t> movable;
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    // A resumable group has one thread.
    const int cores = model.groups[g].resumable ? 1 : model.cores;
    found.push_back(
        exact_schedule(model.groups[g], cores, model.system.inter_core_delay_ns, search_nodes_max));
    shortest.push_back(first_node_first(found.back().orders));
    shortest.back().resize(static_cast<std::size_t>(model.cores));
    if (g > 0 && on_one_core(shortest.back())) movable.push_back(g);
  }

  std::size_t placements = 1;
  for (std::size_t i = 0; i < movable.size(); ++i) {
    placements *= static_cast<std::size_t>(model.cores);
  }
  Plan best;
  std::vector<double> best_tightness;
  for (std::size_t choice = 0; choice < placements; ++choice) {
    Placement placement = shortest;
    std::size_t remaining = choice;
    for (const std::size_t g : movable) {
      // The last core first: it is kept if no other core is better.
      const std::size_t core = static_cast<std::size_t>(model.cores) - 1 -
                               remaining % static_cast<std::size_t>(model.cores);
      std::swap(placement[g][0], placement[g][core]);
      remaining /= static_cast<std::size_t>(model.cores);
    }
    Plan plan = schedule_of(model, placement);
    assign_priorities(model, plan);
    std::vector<double> ratios = tightness(model, plan);
    if (choice > 0 && ratios >= best_tightness) continue;
    best = std::move(plan);
    best_tightness = std::move(ratios);
  }
  for (std::size_t g = 0; g < found.size(); ++g) {
    best.groups[g].makespan_lower_bound_ns = found[g].makespan_lower_bound_ns;
    best.groups[g].optimal = found[g].optimal;
  }
  return best;
}

Plan with_computed_times(const Plan& plan, const TaskModel& model) {
  Plan result = plan;
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    const auto times = times_of(model.groups[g], core_orders(plan, static_cast<int>(g)),
                                model.system.inter_core_delay_ns);
    result.groups[g].makespan_ns = times->makespan_ns;
    for (PlannedNode& node : result.nodes) {
      if (node.group != static_cast<int>(g)) continue;
      node.start_ns = times->start_ns[static_cast<std::size_t>(node.node)];
      node.end_ns = times->end_ns[static_cast<std::size_t>(node.node)];
    }
  }
  return result;
}

}  // namespace glint
