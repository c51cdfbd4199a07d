#include "schedules/static_order.hpp"

#include <algorithm>

namespace glint {

std::optional<OrderTimes> times_of(const TaskGroup& group,
                                   const std::vector<std::vector<int>>& orders,
                                   std::int64_t inter_core_delay_ns) {
  const std::size_t count = group.nodes.size();
  OrderTimes times{std::vector<std::int64_t>(count), std::vector<std::int64_t>(count),
                   std::vector<int>(count, -1), 0, 0};
  std::size_t listed = 0;
  for (std::size_t core = 0; core < orders.size(); ++core) {
    if (!orders[core].empty()) ++times.cores_used;
    for (const int node : orders[core]) times.core[static_cast<std::size_t>(node)] = int(core);
    listed += orders[core].size();
  }

  std::vector<bool> done(count, false);
  std::vector<std::size_t> next(orders.size(), 0);
  std::vector<std::int64_t> free_at(orders.size(), 0);
  const auto ready_at = [&](int node) -> std::optional<std::int64_t> {
    const int core = times.core[static_cast<std::size_t>(node)];
    std::int64_t ready = free_at[static_cast<std::size_t>(core)];
    for (const int before : group.nodes[static_cast<std::size_t>(node)].after) {
      const auto index = static_cast<std::size_t>(before);
      if (!done[index]) return std::nullopt;
      ready = std::max(ready,
                       times.end_ns[index] + (times.core[index] == core ? 0 : inter_core_delay_ns));
    }
    return ready;
  };

  std::size_t placed = 0;
  for (bool moved = true; moved;) {
    moved = false;
    for (std::size_t core = 0; core < orders.size(); ++core) {
      for (; next[core] < orders[core].size(); ++next[core]) {
        const auto node = static_cast<std::size_t>(orders[core][next[core]]);
        const auto start = ready_at(static_cast<int>(node));
        if (!start) break;
        times.start_ns[node] = *start;
        times.end_ns[node] = free_at[core] = *start + group.nodes[node].bound_ns;
        times.makespan_ns = std::max(times.makespan_ns, times.end_ns[node]);
        done[node] = true;
        moved = true;
        ++placed;
      }
    }
  }
  if (placed < listed) return std::nullopt;
  return times;
}

}  // namespace glint
