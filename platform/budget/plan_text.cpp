#include <cstdarg>
#include <cstdio>

#include "platform/budget/plan_file.hpp"
#include "schedules/static_order.hpp"

namespace glint {
namespace {

std::string line(const char* format, ...) __attribute__((format(printf, 1, 2)));
std::string line(const char* format, ...) {
  char text[400];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  return text;
}

long long wide(std::int64_t value) { return value; }

}  // namespace

std::string plan_text(const Plan& plan, const TaskModel& model) {
  std::string text =
      "# Cores and order of the nodes: a core runs its nodes in the order of these lines. To "
      "edit,\n"
      "# move a line or change its core and omit start_ns, which is then computed.\n"
      "# `glint budget check` checks an edited plan.\n";
  text += "graph = \"" + plan.graph_signature + "\"\n";
  text += "board = \"" + plan.board + "\"\n";
  text += "board_sha256 = \"" + plan.board_sha256 + "\"\n";
  text += line("cores = %d\n\n[bus]\n", plan.cores);
  text += line("frames = \"%s\"\nbit_rate = %lld\ndata_bit_rate = %lld\ntools = %d\ntick_hz = %g\n",
               std::string(name_of(plan.traffic.format)).c_str(),
               wide(static_cast<std::int64_t>(plan.bus.nominal)),
               wide(static_cast<std::int64_t>(plan.bus.data)), plan.traffic.tools,
               plan.traffic.tick_hz);
  for (std::size_t g = 0; g < plan.groups.size(); ++g) {
    const PlannedGroup& group = plan.groups[g];
    text += line("\n[[group]]   # %lld ns from its release to its end, undisturbed\n",
                 wide(group.makespan_ns));
    text += "name = \"" + group.name + "\"\n";
    text +=
        line("priority = %d\noptimal = %s\nleast_possible_ns = %lld\nnodes = [\n", group.priority,
             group.optimal ? "true" : "false", wide(group.makespan_lower_bound_ns));
    const auto orders = core_orders(plan, static_cast<int>(g));
    for (std::size_t core = 0; core < orders.size(); ++core) {
      for (const int n : orders[core]) {
        for (const PlannedNode& node : plan.nodes) {
          if (node.group != static_cast<int>(g) || node.node != n) continue;
          text += line("  { node = \"%s\", core = %zu, start_ns = %lld, bound_ns = %lld },\n",
                       node_name(model.groups[g].nodes[static_cast<std::size_t>(n)]).c_str(), core,
                       wide(node.start_ns), wide(node.end_ns - node.start_ns));
        }
      }
    }
    text += "]\n";
  }
  return text;
}

}  // namespace glint
