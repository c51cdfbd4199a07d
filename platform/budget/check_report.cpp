// Result of a check as JSON and as a text table.
#include <cstdarg>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "platform/budget/check.hpp"
#include "platform/budget/slack_table.hpp"
#include "schedules/sensitivity.hpp"

namespace glint {
namespace {

using nlohmann::ordered_json;

double us(std::int64_t ns) { return static_cast<double>(ns) * 1e-3; }

// Null if there is no bound, or no factor for which all deadlines are met.
ordered_json us_or_null(const std::optional<std::int64_t>& ns) {
  return ns ? ordered_json(us(*ns)) : ordered_json();
}
ordered_json percent_or_null(const std::optional<double>& factor) {
  return factor ? ordered_json(slack_percent(*factor)) : ordered_json();
}

const KernelSlack* slack_of(const CheckResult& result, std::size_t group, const std::string& name) {
  for (const KernelSlack& slack : result.kernels) {
    if (slack.group == group && slack.name == name) return &slack;
  }
  return nullptr;
}

const char* kind_of(const CheckResult& result, const std::string& kernel) {
  return result.estimated.contains(kernel) ? "estimated" : "proved";
}

ordered_json groups_json(const CheckResult& result) {
  ordered_json groups = ordered_json::array();
  for (std::size_t g = 0; g < result.assessment.groups.size(); ++g) {
    const GroupResponse& group = result.assessment.groups[g];
    groups.push_back({{"name", group.name},
                      {"priority", group.priority},
                      {"makespan_us", us(group.times.makespan_ns)},
                      {"response_us", us_or_null(group.response_ns)},
                      {"deadline_us", us(group.deadline_ns)},
                      {"slack_percent", percent_or_null(result.groups[g])},
                      {"blocking_us", us(group.blocking_ns)},
                      {"jitter_us", us(group.jitter_ns)}});
  }
  return groups;
}

ordered_json nodes_json(const CheckResult& result) {
  ordered_json nodes = ordered_json::array();
  for (std::size_t g = 0; g < result.analysis_input.model.groups.size(); ++g) {
    const TaskGroup& group = result.analysis_input.model.groups[g];
    const OrderTimes& times = result.assessment.groups[g].times;
    for (std::size_t n = 0; n < group.nodes.size(); ++n) {
      const KernelSlack* slack = slack_of(result, g, group.nodes[n].name);
      nodes.push_back({{"group", group.name},
                       {"name", group.nodes[n].name},
                       {"copy", group.nodes[n].copy},
                       {"core", times.core.empty() ? -1 : times.core[n]},
                       {"start_us", times.core.empty() ? 0 : us(times.start_ns[n])},
                       {"bound_us", us(group.nodes[n].bound_ns)},
                       {"kind", kind_of(result, group.nodes[n].name)},
                       {"slack_percent", percent_or_null(slack->one_copy)},
                       {"may_grow_percent", percent_or_null(slack->all_copies)}});
    }
  }
  return nodes;
}

ordered_json chains_json(const CheckResult& result) {
  ordered_json chains = ordered_json::array();
  for (std::size_t c = 0; c < result.assessment.chains.size(); ++c) {
    const Chain& chain = result.assessment.chains[c];
    ordered_json stages = ordered_json::array();
    for (const ChainStage& stage : chain.stages) {
      stages.push_back({{"name", stage.name}, {"kind", name_of(stage.kind)}, {"us", us(stage.ns)}});
    }
    chains.push_back({{"name", chain.name},
                      {"deadline_us", us(chain.deadline_ns)},
                      {"bound_us", us(chain.total_ns)},
                      {"estimate_us", us(chain.estimate_ns)},
                      {"slack_percent", percent_or_null(result.chains[c])},
                      {"maximum_reaction_time_us", us(chain.maximum_reaction_time_ns)},
                      {"maximum_data_age_us", us(chain.maximum_data_age_ns)},
                      {"jitter_us", us(chain.jitter_ns)},
                      {"stages", stages}});
  }
  return chains;
}

ordered_json can_json(const CheckResult& result) {
  ordered_json frames = ordered_json::array();
  for (std::size_t f = 0; f < result.analysis_input.frames.size(); ++f) {
    const CanMessage& frame = result.analysis_input.frames[f];
    frames.push_back({{"name", frame.name},
                      {"identifier", frame.identifier},
                      {"response_us", us_or_null(result.assessment.can[f].response_ns)},
                      {"deadline_us", us(frame.deadline_ns)}});
  }
  return frames;
}

std::string line(const char* format, ...) __attribute__((format(printf, 1, 2)));
std::string line(const char* format, ...) {
  char text[240];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  return text;
}

std::string shown(const std::optional<std::int64_t>& ns) {
  return ns ? line("%10.1f", us(*ns)) : "      none";
}

}  // namespace

std::vector<std::string> invalid_reasons(const CheckInput& input, const CheckResult& result) {
  std::vector<std::string> reasons = result.what_if;
  if (!input.plan.board_sha256.empty() && input.plan.board_sha256 != input.board.sha256) {
    reasons.push_back("the plan belongs to another version of the board file " + input.plan.board);
  }
  return reasons;
}

ordered_json check_json(const CheckInput& input, const CheckOptions& options,
                        const CheckResult& result) {
  const Limits& limits = input.limits;
  const SystemShare& system = result.analysis_input.model.system;
  ordered_json json{
      {"board", input.board.name},
      {"board_sha256", input.board.sha256},
      {"counter", input.board.counter == CostCounter::time ? "time" : "instructions"},
      {"plan", input.plan.board_sha256 == input.board.sha256 ? "of this board" : "of another"},
      {"cores", input.plan.cores},
      {"limits",
       {{"width", limits.width},
        {"height", limits.height},
        {"tools", limits.tools},
        {"markers_per_tool", limits.markers_per_tool},
        {"blobs", limits.blobs}}},
      {"void", invalid_reasons(input, result)},
      {"estimated", result.estimated},
      {"groups", groups_json(result)},
      {"nodes", nodes_json(result)},
      {"chains", chains_json(result)},
      {"can", can_json(result)},
      {"bus_load", result.bus_load},
      {"system_slack_percent", percent_or_null(result.system)},
      {"break_even_clock",
       result.system && *result.system > 0 ? ordered_json(1 / *result.system) : ordered_json()},
      {"largest", {{"roi_pixels", result.roi_pixels_largest}, {"tools", result.tools_largest}}},
      {"estimates",
       {{"wake_up_us", us(system.wake_up_ns)},
        {"interrupt_us", us(system.interrupt_ns)},
        {"interrupt_gap_us", us(system.interrupt_gap_ns)},
        {"can_write_us", us(system.can_write_ns)},
        {"core_handover_us", us(system.inter_core_delay_ns)}}},
      {"margin_percent", options.margin_percent},
      {"verdict", result.fails.empty() ? "holds" : "fails"},
      {"fails", result.fails}};
  return json;
}

std::string check_table(const CheckInput& input, const CheckResult& result) {
  std::string text = "board    " + input.board.name + "  " + input.board.sha256.substr(0, 16) +
                     line("   %d core%s\n", input.plan.cores, input.plan.cores == 1 ? "" : "s");
  for (const std::string& reason : invalid_reasons(input, result))
    text += "void     " + reason + "\n";
  text += "\ngroup           priority   makespan   response   deadline us  slack %\n";
  for (std::size_t g = 0; g < result.assessment.groups.size(); ++g) {
    const GroupResponse& group = result.assessment.groups[g];
    text += line("%-16s%8d %10.1f %s %10.1f %s\n", group.name.c_str(), group.priority,
                 us(group.times.makespan_ns), shown(group.response_ns).c_str(),
                 us(group.deadline_ns), shown_slack(result.groups[g]).c_str());
  }
  for (std::size_t c = 0; c < result.assessment.chains.size(); ++c) {
    const Chain& chain = result.assessment.chains[c];
    text += line("\nchain %s\n", chain.name.c_str());
    for (const ChainStage& stage : chain.stages) {
      text +=
          line("  %-38s %10.1f us  %s\n", stage.name.c_str(), us(stage.ns), name_of(stage.kind));
    }
    text += line("  %-38s %10.1f us  of it %.1f us estimate; deadline %.1f us, slack %s %%\n",
                 "total", us(chain.total_ns), us(chain.estimate_ns), us(chain.deadline_ns),
                 shown_slack(result.chains[c]).c_str());
    text += line("  maximum reaction time %.1f us, maximum data age %.1f us, jitter %.1f us\n",
                 us(chain.maximum_reaction_time_ns), us(chain.maximum_data_age_ns),
                 us(chain.jitter_ns));
  }
  text += "\n                                  bound us   may grow %\n" + node_slack_rows(result);
  text += "\n";
  for (const KernelSlack& kernel : result.kernels) {
    const auto why = result.estimated.find(kernel.name);
    text += line("%-9s %-24.60s%s\n", kind_of(result, kernel.name), kernel.name.c_str(),
                 why == result.estimated.end() ? "" : (" " + why->second).c_str());
  }
  std::size_t slowest = 0;
  for (std::size_t f = 1; f < result.analysis_input.frames.size(); ++f) {
    if (result.analysis_input.frames[f].deadline_ns ==
            result.analysis_input.frames[0].deadline_ns &&
        result.assessment.can[f].response_ns > result.assessment.can[slowest].response_ns) {
      slowest = f;
    }
  }
  text += line("\nCAN      %.1f %% of the bus; slowest frame of a tick: %s,%s us after it\n",
               100 * result.bus_load, result.analysis_input.frames[slowest].name.c_str(),
               shown(result.assessment.can[slowest].response_ns).c_str());
  text += line("system   slack %s %%", shown_slack(result.system).c_str());
  if (result.system && *result.system > 0) {
    text += line(", holds down to %.3f of the clock", 1 / *result.system);
  }
  text += line("\nfits     at most %d tools; %lld searched pixels\n", result.tools_largest,
               result.roi_pixels_largest);
  for (const std::string& fail : result.fails) text += "FAILS    " + fail + "\n";
  if (result.fails.empty()) text += "holds    every deadline, with the required margin\n";
  return text;
}

}  // namespace glint
