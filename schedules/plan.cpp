#include "schedules/plan.hpp"

#include <algorithm>

namespace glint {

std::string node_name(const TaskNode& node) {
  std::string name = node.name;
  if (node.copies > 1) name.append(1, '#').append(std::to_string(node.copy));
  return name;
}

std::vector<std::vector<int>> core_orders(const Plan& plan, int group) {
  std::vector<PlannedNode> nodes;
  for (const PlannedNode& node : plan.nodes) {
    if (node.group == group) nodes.push_back(node);
  }
  // Nodes with equal start (one takes no time) keep their order in the plan.
  std::stable_sort(nodes.begin(), nodes.end(), [](const PlannedNode& a, const PlannedNode& b) {
    return a.start_ns < b.start_ns;
  });
  std::vector<std::vector<int>> orders(static_cast<std::size_t>(std::max(plan.cores, 1)));
  for (const PlannedNode& node : nodes) {
    orders.at(static_cast<std::size_t>(node.core)).push_back(node.node);
  }
  return orders;
}

}  // namespace glint
