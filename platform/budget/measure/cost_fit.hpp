// From calls to costs: the envelope of one half, judged on the other, and whether the bound holds.
#pragma once

#include <array>
#include <optional>

#include "platform/budget/board_file.hpp"
#include "platform/budget/measure/observations.hpp"

namespace glint {

// At one set of limits.
struct BoundCheck {
  double bound = 0;         // declared maxima times costs
  double observed_max = 0;  // of all inputs made for these limits
  [[nodiscard]] bool holds() const { return observed_max <= bound; }
  [[nodiscard]] double ratio() const { return observed_max > 0 ? bound / observed_max : 0; }
};

struct MeasuredCosts {
  std::string name;
  std::vector<std::string> loops;
  std::vector<double> cost;  // a count; thousandths, rounded up
  graph::LoopCounts declared, observed;
  std::array<BoundCheck, k_limit_sets> at;  // Limits{} and a cell's
  EnvelopeJudgement fit_half, judge_half;
  MeasuredInput worst_input;  // the dearest of all
  std::vector<double> sorted_costs;
  std::int64_t beyond_declared = 0;  // calls in which a loop ran more often than its node declares
  [[nodiscard]] bool holds() const {
    return at[0].holds() && at[1].holds() && beyond_declared == 0;
  }
};

// With the costs of a board (in its counter's unit), or with an envelope that is fitted now.
// Throws InputError where there is no envelope.
[[nodiscard]] MeasuredCosts costs_of(const KernelObservations& kernel, const BoardKernel* board,
                                     double margin);

[[nodiscard]] double quantile(const std::vector<double>& sorted, double share);

}  // namespace glint
