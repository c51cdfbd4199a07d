#include "platform/budget/check.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "platform/budget/bus_frames.hpp"
#include "platform/budget/plan_file.hpp"
#include "platform/budget/task_model_of.hpp"
#include "platform/input_error.hpp"
#include "schedules/plan_check.hpp"
#include "schedules/sensitivity.hpp"

namespace glint {
namespace {

TaskModel what_if_model(const CheckInput& input, const CheckOptions& options,
                        const Limits& limits) {
  TaskModel model = task_model_of(input.cell, input.board.table(), input.board.system, limits);
  model.cores = input.plan.cores;
  const CheckInput limited{input.cell, input.board, input.plan, limits, input.foreign};
  for (TaskGroup& group : model.groups) {
    for (TaskNode& node : group.nodes) {
      if (estimated_because(limited, options, node.name)) continue;
      node.bound_ns = static_cast<std::int64_t>(
          std::ceil(static_cast<double>(options.proved.instructions.at(node.name)) *
                    input.board.ns_per_instruction));
    }
  }
  for (const auto& [kernel, factor] : options.scale) {
    model = scaled(model, factor, [&, &name = kernel](std::size_t g, std::size_t n) {
      return model.groups[g].nodes[n].name == name;
    });
  }
  if (options.clock != 1) {
    model = scaled(
        model, 1 / options.clock, [](std::size_t, std::size_t) { return true; }, true);
  }
  return model;
}

void check_scale(const AnalysisInput& analysis_input, const CheckOptions& options) {
  std::string known;
  for (const TaskGroup& group : analysis_input.model.groups) {
    for (const TaskNode& node : group.nodes) {
      if (node.copy == 0) known += (known.empty() ? "" : ", ") + node.name;
    }
  }
  for (const auto& [kernel, factor] : options.scale) {
    if ((", " + known + ",").find(", " + kernel + ",") != std::string::npos) continue;
    throw InputError("--scale " + kernel + ": unknown node; expected one of " + known);
  }
}

// Repeats the check with the same schedule for other limits (tools or pixels).
bool fits(const CheckInput& input, const CheckOptions& options, const Limits& limits) {
  CheckInput other{input.cell, input.board, input.plan, limits, input.foreign};
  return assess(analysis_input_of(other, options)).holds();
}

void add_kernels(CheckResult& result) {
  const AnalysisInput& analysis_input = result.analysis_input;
  for (std::size_t g = 0; g < analysis_input.model.groups.size(); ++g) {
    const auto& nodes = analysis_input.model.groups[g].nodes;
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      if (nodes[n].copy != 0) continue;
      KernelSlack slack{g, nodes[n].name, {}, {}};
      slack.one_copy = largest_factor(analysis_input, [&](std::size_t group, std::size_t node) {
        return group == g && node == n;
      });
      slack.all_copies =
          nodes[n].copies == 1
              ? slack.one_copy
              : largest_factor(analysis_input, [&](std::size_t group, std::size_t node) {
                  return group == g && nodes[node].name == nodes[n].name;
                });
      result.kernels.push_back(slack);
    }
  }
}

void add_estimated(const CheckInput& input, const CheckOptions& options, CheckResult& result) {
  for (const KernelSlack& kernel : result.kernels) {
    const std::optional<std::string> why = estimated_because(input, options, kernel.name);
    if (!why) continue;
    result.estimated[kernel.name] = *why;
    if (options.require_proved) {
      result.fails.push_back(kernel.name +
                             ": the bound is estimated, expected a proved one: " + *why);
    }
  }
}

void add_largest(const CheckInput& input, const CheckOptions& options, CheckResult& result) {
  for (int tools = k_tools_max; tools > 0 && result.tools_largest == 0; --tools) {
    Limits limits = input.limits;
    limits.tools = tools;
    if (fits(input, options, limits)) result.tools_largest = tools;
  }
  // Bisection in rows: the largest number for which all deadlines are met.
  int low = 0, high = k_height_max;
  while (low < high) {
    const int rows = (low + high + 1) / 2;
    Limits limits = input.limits;
    limits.height = rows;
    if (fits(input, options, limits)) {
      low = rows;
    } else {
      high = rows - 1;
    }
  }
  result.roi_pixels_largest = static_cast<long long>(low) * input.limits.width;
}

}  // namespace

std::optional<std::string> estimated_because(const CheckInput& input, const CheckOptions& options,
                                             const std::string& kernel) {
  const ProvedBounds& proved = options.proved;
  if (const auto refused = proved.refused.find(kernel); refused != proved.refused.end()) {
    return refused->second;
  }
  if (!proved.instructions.contains(kernel)) return "no proof";
  if (input.board.counter != CostCounter::instructions) return "the board counts time";
  if (!covers(proved.limits, input.limits)) return "the proof is of smaller limits";
  return std::nullopt;
}

Plan validated_plan(const std::string& file, TaskModel& model, const Limits& limits) {
  Plan plan = load_plan(file, model, graphs_signature(model));
  model.cores = plan.cores;
  if (const auto faults = check_plan(plan, model); !faults.empty()) {
    throw InputError(file + ": " + faults.front());
  }
  if (plan.traffic.tools < limits.tools) {
    throw InputError(file + ": made for " + std::to_string(plan.traffic.tools) +
                     " tools; expected " + std::to_string(limits.tools) + " as in the cell");
  }
  return plan;
}

AnalysisInput analysis_input_of(const CheckInput& input, const CheckOptions& options) {
  AnalysisInput analysis_input;
  analysis_input.model = what_if_model(input, options, input.limits);
  analysis_input.plan = input.plan;
  analysis_input.sensor = {input.cell.camera.exposure.nanoseconds,
                           input.cell.camera.transport.nanoseconds};
  analysis_input.frames = own_frames_of(input.cell, input.limits.tools);
  analysis_input.frames.insert(analysis_input.frames.end(), input.foreign.begin(),
                               input.foreign.end());
  analysis_input.rates = bit_rates_of(input.cell);
  analysis_input.frame_to_can_deadline_ns = input.cell.deadlines.frame_to_can.nanoseconds;
  analysis_input.age_deadline_ns = input.cell.lost_after.nanoseconds;
  return analysis_input;
}

CheckResult check(const CheckInput& input, const CheckOptions& options) {
  CheckResult result;
  result.analysis_input = analysis_input_of(input, options);
  check_scale(result.analysis_input, options);
  result.assessment = assess(result.analysis_input);
  result.fails = result.assessment.missed_deadlines;
  result.bus_load = load_of(result.analysis_input.frames, result.analysis_input.rates);
  for (const auto& [kernel, factor] : options.scale) {
    char text[160];
    std::snprintf(text, sizeof text, "variation: %.80s takes %g times its bound", kernel.c_str(),
                  factor);
    result.what_if.emplace_back(text);
  }
  if (options.clock != 1) {
    char text[80];
    std::snprintf(text, sizeof text, "variation: the clock runs at %g of the declared frequency",
                  options.clock);
    result.what_if.emplace_back(text);
  }

  add_kernels(result);
  add_estimated(input, options, result);
  const auto everything = [](std::size_t, std::size_t) { return true; };
  for (std::size_t g = 0; g < result.analysis_input.model.groups.size(); ++g) {
    result.groups.push_back(largest_factor(
        result.analysis_input, [g](std::size_t group, std::size_t) { return group == g; }));
  }
  // Both chains include the frame and the tick group.
  const auto chain = largest_factor(result.analysis_input, [](std::size_t group, std::size_t) {
    return group == k_frame_group_index || group == k_tick_group_index;
  });
  result.chains.assign(result.assessment.chains.size(), chain);
  result.system = largest_factor(result.analysis_input, everything, true);
  add_largest(input, options, result);

  const double slack = result.system ? slack_percent(*result.system) : -100;
  if (slack < options.margin_percent) {
    char text[120];
    std::snprintf(text, sizeof text, "margin: slack of the system %.1f %%, policy %.1f %%", slack,
                  options.margin_percent);
    result.fails.emplace_back(text);
  }
  if (!options.observed.empty()) compare_observed(options.observed, result);
  return result;
}

}  // namespace glint
