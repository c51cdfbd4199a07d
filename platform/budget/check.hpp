// Result of `glint budget check`: an assessment, the slack of each part, and the largest problem
// that still fits.
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "platform/budget/board_file.hpp"
#include "platform/budget/proved_bounds.hpp"
#include "platform/cells/cell.hpp"
#include "schedules/assessment.hpp"

namespace glint {

struct CheckOptions {
  std::map<std::string, double> scale;  // what-if factor on a kernel's bound, by kernel
  double clock = 1;                     // what-if fraction of the board's clock
  double margin_percent = 0;            // policy: minimum slack of the whole system
  std::string foreign;                  // file of other nodes' frames; empty: none
  std::string observed;                 // summary.json of a run; empty: none
  ProvedBounds proved;                  // of the program that runs; they replace the board's
  bool require_proved = false;          // an estimated bound is a failure
};

// Input of check(), which throws InputError for a scale of an unknown kernel. validated_plan()
// rejects a schedule that does not match the cell and the board.
struct CheckInput {
  const Cell& cell;
  const Board& board;
  Plan plan;
  Limits limits;
  std::vector<CanMessage> foreign;
};

// Loads and validates a schedule for this model; sets the model's number of cores from it. Throws
// InputError for a schedule of another graph, an infeasible one, or one made for fewer tools than
// `limits`.
[[nodiscard]] Plan validated_plan(const std::string& file, TaskModel& model, const Limits& limits);

// The question with the options applied.
[[nodiscard]] AnalysisInput analysis_input_of(const CheckInput& input, const CheckOptions& options);

// Why a kernel's bound is estimated: it is the board's envelope of measured calls. Nothing if it is
// proved.
[[nodiscard]] std::optional<std::string> estimated_because(const CheckInput& input,
                                                           const CheckOptions& options,
                                                           const std::string& kernel);

struct KernelSlack {
  std::size_t group = 0;
  std::string name;
  std::optional<double> one_copy;  // largest factor on one copy's bound
  std::optional<double> all_copies;
};

struct CheckResult {
  AnalysisInput analysis_input;
  Assessment assessment;
  std::vector<KernelSlack> kernels;
  std::vector<std::optional<double>> groups;  // largest factor on all bounds of a group
  std::vector<std::optional<double>> chains;  // on the bounds of all groups of a chain
  std::optional<double> system;               // on every bound and the system's share
  int tools_largest = 0;                      // that still fit; 0: not even one
  long long roi_pixels_largest = 0;           // searched pixels that still fit
  double bus_load = 0;
  std::map<std::string, std::string> estimated;  // by kernel: why its bound is not proved
  std::vector<std::string> what_if;              // options for which the result is hypothetical
  std::vector<std::string> fails;                // violated deadlines, bounds or policy
};

[[nodiscard]] CheckResult check(const CheckInput& input, const CheckOptions& options);

// Reasons why the bounds do not hold for this schedule on this board.
[[nodiscard]] std::vector<std::string> invalid_reasons(const CheckInput& input,
                                                       const CheckResult& result);

// Adds to `fails` each observation above its bound.
void compare_observed(const std::string& summary_file, CheckResult& result);

[[nodiscard]] nlohmann::ordered_json check_json(const CheckInput& input,
                                                const CheckOptions& options,
                                                const CheckResult& result);
[[nodiscard]] std::string check_table(const CheckInput& input, const CheckResult& result);

}  // namespace glint
