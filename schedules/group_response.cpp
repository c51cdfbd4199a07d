#include "schedules/group_response.hpp"

#include <algorithm>
#include <numeric>

#include "schedules/response_time.hpp"

namespace glint {
namespace {

bool uses(const OrderTimes& times, int core) {
  return std::find(times.core.begin(), times.core.end(), core) != times.core.end();
}

std::int64_t writes_ns(const TaskModel& model, const TaskGroup& group) {
  return group.can_writes * model.system.can_write_ns;
}

// Longest time that one activation occupies a core that it uses.
std::int64_t occupied_ns(const TaskModel& model, const TaskGroup& group, const GroupResponse& of) {
  if (of.times.cores_used > 1) return *of.response_ns - of.jitter_ns;
  return of.times.makespan_ns + writes_ns(model, group);
}

}  // namespace

std::vector<GroupResponse> group_responses(const TaskModel& model, const Plan& plan) {
  const std::size_t count = model.groups.size();
  std::vector<GroupResponse> responses(count);
  bool cyclic = false;
  for (std::size_t g = 0; g < count; ++g) {
    const TaskGroup& group = model.groups[g];
    const int priority = g < plan.groups.size() ? plan.groups[g].priority : group.priority;
    auto times =
        times_of(group, core_orders(plan, static_cast<int>(g)), model.system.inter_core_delay_ns);
    cyclic = cyclic || !times;
    responses[g] = {group.name,      priority,         times ? *times : OrderTimes{}, {}, 0,
                    group.jitter_ns, group.deadline_ns};
  }
  if (cyclic) return responses;

  std::vector<std::size_t> by_priority(count);
  std::iota(by_priority.begin(), by_priority.end(), std::size_t{0});
  std::stable_sort(by_priority.begin(), by_priority.end(), [&](std::size_t a, std::size_t b) {
    return responses[a].priority > responses[b].priority;
  });

  for (std::size_t rank = 0; rank < count; ++rank) {
    const std::size_t g = by_priority[rank];
    GroupResponse& own = responses[g];
    std::vector<Interference> higher;
    bool unbounded_above = false;
    for (int core = 0; core < plan.cores; ++core) {
      if (!uses(own.times, core)) continue;
      if (model.system.interrupt_ns > 0) {
        higher.push_back({model.system.interrupt_ns, model.system.interrupt_gap_ns, 0});
      }
      for (std::size_t above = 0; above < rank; ++above) {
        const std::size_t h = by_priority[above];
        if (!uses(responses[h].times, core)) continue;
        unbounded_above = unbounded_above || !responses[h].response_ns;
        if (unbounded_above) break;
        higher.push_back({occupied_ns(model, model.groups[h], responses[h]),
                          model.groups[h].min_gap_ns,
                          model.groups[h].jitter_ns + model.system.wake_up_ns});
      }
      std::int64_t slice = 0;
      for (std::size_t below = rank + 1; below < count; ++below) {
        const std::size_t l = by_priority[below];
        if (uses(responses[l].times, core)) {
          slice = std::max(slice, model.groups[l].longest_slice_ns);
        }
      }
      own.blocking_ns += slice;
    }
    if (unbounded_above) continue;
    // The first worker wakes up at the release and then wakes the others.
    const int wake_ups = own.times.cores_used > 1 ? 2 : 1;
    const std::int64_t cost = own.times.makespan_ns + writes_ns(model, model.groups[g]) +
                              wake_ups * model.system.wake_up_ns;
    const auto bound =
        response_time({cost, model.groups[g].min_gap_ns, own.jitter_ns, own.blocking_ns}, higher);
    if (bound) own.response_ns = bound->response_ns;
  }
  return responses;
}

}  // namespace glint
