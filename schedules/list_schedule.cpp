#include "schedules/list_schedule.hpp"

#include <algorithm>

namespace glint {

std::vector<std::int64_t> levels_of(const TaskGroup& group) {
  std::vector<std::int64_t> level(group.nodes.size(), 0);
  // Nodes are in topological order: all readers of a node follow it.
  for (std::size_t n = group.nodes.size(); n-- > 0;) {
    level[n] += group.nodes[n].bound_ns;
    for (const int before : group.nodes[n].after) {
      auto& own = level[static_cast<std::size_t>(before)];
      own = std::max(own, level[n]);
    }
  }
  return level;
}

CoreOrders list_schedule(const TaskGroup& group, int cores, std::int64_t inter_core_delay_ns) {
  const std::size_t count = group.nodes.size();
  const std::vector<std::int64_t> level = levels_of(group);
  CoreOrders orders(static_cast<std::size_t>(cores));
  std::vector<std::int64_t> free_at(orders.size(), 0), end(count, 0);
  std::vector<int> core_of(count, -1);

  const auto is_ready = [&](std::size_t n) {
    return core_of[n] < 0 &&
           std::all_of(group.nodes[n].after.begin(), group.nodes[n].after.end(),
                       [&](int b) { return core_of[static_cast<std::size_t>(b)] >= 0; });
  };
  const auto start_on = [&](std::size_t n, std::size_t core) {
    std::int64_t start = free_at[core];
    for (const int before : group.nodes[n].after) {
      const auto b = static_cast<std::size_t>(before);
      start = std::max(start,
                       end[b] + (core_of[b] == static_cast<int>(core) ? 0 : inter_core_delay_ns));
    }
    return start;
  };

  for (std::size_t placed = 0; placed < count; ++placed) {
    std::size_t best = count;
    for (std::size_t n = 0; n < count; ++n) {
      if (is_ready(n) && (best == count || level[n] > level[best])) best = n;
    }
    std::size_t core = 0;
    for (std::size_t c = 1; c < orders.size(); ++c) {
      if (start_on(best, c) < start_on(best, core)) core = c;
    }
    end[best] = free_at[core] = start_on(best, core) + group.nodes[best].bound_ns;
    core_of[best] = static_cast<int>(core);
    orders[core].push_back(static_cast<int>(best));
  }
  return orders;
}

}  // namespace glint
