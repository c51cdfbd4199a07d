// What `glint budget check` finds: an assessment, how far each part of it may grow, and what else
// would still fit.
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "platform/budget/board_file.hpp"
#include "platform/cells/cell.hpp"
#include "schedules/assessment.hpp"

namespace glint {

struct CheckOptions {
  std::map<std::string, double> scale;  // by kernel: what if it were so much slower
  double clock = 1;                     // what if the board ran at this fraction of its clock
  double margin_percent = 0;            // policy: the least slack of the whole system
  std::string foreign;                  // a file of other nodes' frames; empty: none
  std::string observed;                 // a summary.json; empty: none
};

// Throws InputError for a plan that does not fit the cell and the board, or a scale of a kernel
// that there is not.
struct CheckInput {
  const Cell& cell;
  const Board& board;
  Plan plan;
  Limits limits;
  std::vector<CanMessage> foreign;
};

// As loaded and validated for this model, which takes its number of cores. Throws InputError for a
// plan of another graph, one that cannot run, or one that was made for fewer tools than `limits`.
[[nodiscard]] Plan validated_plan(const std::string& file, TaskModel& model, const Limits& limits);

// The question as the options make it.
[[nodiscard]] Question question_of(const CheckInput& input, const CheckOptions& options);

struct KernelSlack {
  std::size_t group = 0;
  std::string name;
  std::optional<double> one_copy;  // largest factor on one copy's bound
  std::optional<double> all_copies;
};

struct CheckResult {
  Question question;
  Assessment assessment;
  std::vector<KernelSlack> kernels;
  std::vector<std::optional<double>> groups;  // largest factor on all bounds of a group
  std::vector<std::optional<double>> chains;  // on the bounds of all groups of a chain
  std::optional<double> system;               // on every bound and the system's share
  int tools_largest = 0;                      // that still fit; 0: not even one
  long long roi_pixels_largest = 0;           // searched pixels that still fit
  double bus_load = 0;
  std::vector<std::string> what_if;  // the options that make this no statement of fact
  std::vector<std::string> fails;    // what breaks deadlines, bounds or the policy
};

[[nodiscard]] CheckResult check(const CheckInput& input, const CheckOptions& options);

// Why the bounds are no statement about this plan on this board.
[[nodiscard]] std::vector<std::string> void_reasons(const CheckInput& input,
                                                    const CheckResult& result);

// Adds to `fails` where what was observed is above its bound.
void compare_observed(const std::string& summary_file, CheckResult& result);

[[nodiscard]] nlohmann::ordered_json check_json(const CheckInput& input,
                                                const CheckOptions& options,
                                                const CheckResult& result);
[[nodiscard]] std::string check_table(const CheckInput& input, const CheckResult& result);

}  // namespace glint
