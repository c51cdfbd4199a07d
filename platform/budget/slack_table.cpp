#include "platform/budget/slack_table.hpp"

#include <cstdio>

#include "schedules/sensitivity.hpp"

namespace glint {
namespace {

std::string row(const char* kind, const std::string& name, std::int64_t bound_ns,
                const std::optional<double>& factor) {
  char text[160];
  std::snprintf(text, sizeof text, "%-6s %-24.60s %10.1f   ", kind, name.c_str(),
                static_cast<double>(bound_ns) * 1e-3);
  return text + shown_slack(factor) + "\n";
}

}  // namespace

std::string shown_slack(const std::optional<double>& factor) {
  if (!factor) return "    none";
  if (*factor >= k_factor_max) return "  > 99900";
  char text[40];
  std::snprintf(text, sizeof text, "%+8.1f", slack_percent(*factor));
  return text;
}

std::string node_slack_rows(const CheckResult& result) {
  std::string text;
  for (const KernelSlack& slack : result.kernels) {
    for (const TaskNode& node : result.analysis_input.model.groups[slack.group].nodes) {
      if (node.name != slack.name || node.copy != 0) continue;
      const std::string copies = node.copies > 1 ? " x" + std::to_string(node.copies) : "";
      text += row("node", node.name + copies, node.bound_ns, slack.all_copies);
    }
  }
  return text;
}

std::string slack_table(const CheckResult& result) {
  std::string text = "slack                             bound us   may grow %\n";
  text += node_slack_rows(result);
  for (std::size_t c = 0; c < result.assessment.chains.size(); ++c) {
    const Chain& chain = result.assessment.chains[c];
    text += row("chain", chain.name, chain.total_ns, result.chains[c]);
  }
  return text + "system                                         " + shown_slack(result.system) +
         "\n";
}

}  // namespace glint
