#include "schedules/makespan_bound.hpp"

#include <algorithm>

namespace glint {

Reach reach_of(const TaskGroup& group) {
  const std::size_t count = group.nodes.size();
  Reach reach(count, std::vector<bool>(count, false));
  // Nodes are in topological order.
  for (std::size_t v = 0; v < count; ++v) {
    for (const int before : group.nodes[v].after) {
      const auto b = static_cast<std::size_t>(before);
      reach[b][v] = true;
      for (std::size_t u = 0; u < b; ++u) {
        if (reach[u][b]) reach[u][v] = true;
      }
    }
  }
  return reach;
}

std::int64_t time_between_min(std::int64_t work_ns, int cores, std::int64_t inter_core_delay_ns) {
  std::int64_t least = work_ns;
  for (std::int64_t used = 2; used <= cores; ++used) {
    const std::int64_t sum = work_ns + 2 * inter_core_delay_ns * (used - 1);
    least = std::min(least, (sum + used - 1) / used);
  }
  return least;
}

std::vector<std::int64_t> tails_of(const TaskGroup& group, const Reach& reach, int cores,
                                   std::int64_t inter_core_delay_ns) {
  const std::size_t count = group.nodes.size();
  std::vector<std::int64_t> tail(count, 0);
  for (std::size_t u = count; u-- > 0;) {
    std::int64_t after = 0, work_after = 0;
    for (std::size_t v = u + 1; v < count; ++v) {
      if (!reach[u][v]) continue;
      std::int64_t between = 0;
      for (std::size_t x = u + 1; x < v; ++x) {
        if (reach[u][x] && reach[x][v]) between += group.nodes[x].bound_ns;
      }
      after = std::max(after, time_between_min(between, cores, inter_core_delay_ns) + tail[v]);
      work_after += group.nodes[v].bound_ns;
    }
    // All successors of u run after it, and no data is sent back at the end.
    after = std::max(after, (work_after + cores - 1) / cores);
    tail[u] = group.nodes[u].bound_ns + after;
  }
  return tail;
}

}  // namespace glint
