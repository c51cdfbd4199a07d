#include "platform/budget/typical_load.hpp"

#include <algorithm>
#include <map>
#include <vector>

#include "platform/budget/export/trace_file.hpp"
#include "platform/input_error.hpp"
#include "schedules/plan.hpp"

namespace glint {

TaskModel typical_load(const TaskModel& model, const std::string& trace_file) {
  const auto trace = read_trace(trace_file);
  std::map<std::pair<std::size_t, std::size_t>, std::vector<std::int64_t>> durations;
  for (const TraceSpan& span : trace.spans) {
    if (is_node(span)) durations[{span.group, span.node}].push_back(span.end_ns - span.begin_ns);
  }
  TaskModel typical = model;
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    if (model.groups[g].resumable) continue;  // keeps the declared bound of its slices
    auto& nodes = typical.groups[g].nodes;
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      const std::string name = node_name(nodes[n]);
      const bool same = g < trace.groups.size() && n < trace.groups[g].nodes.size() &&
                        trace.groups[g].nodes[n] == name;
      auto& spans = durations[{g, n}];
      if (!same || spans.empty()) {
        throw InputError(trace_file + ":1: has no spans of " + name + " as node " +
                         std::to_string(n) + " of group " + model.groups[g].name +
                         "; expected a trace of this program's graphs");
      }
      const auto middle = spans.begin() + static_cast<std::ptrdiff_t>(spans.size() / 2);
      std::nth_element(spans.begin(), middle, spans.end());
      nodes[n].bound_ns = *middle;
    }
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      for (const TaskNode& other : nodes) {
        if (other.name == nodes[n].name) {
          nodes[n].bound_ns = std::max(nodes[n].bound_ns, other.bound_ns);
        }
      }
    }
  }
  return typical;
}

}  // namespace glint
