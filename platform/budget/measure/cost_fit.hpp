// Fit of loop costs to measured calls: envelope of one half of the inputs, judged on the other half
// and against the bound.
#pragma once

#include <array>
#include <optional>

#include "platform/budget/board_file.hpp"
#include "platform/budget/measure/observations.hpp"

namespace glint {

// Check of the bound at one set of limits.
struct BoundCheck {
  double bound = 0;         // declared maxima times costs
  double observed_max = 0;  // over all inputs made for these limits
  [[nodiscard]] bool holds() const { return observed_max <= bound; }
  [[nodiscard]] double ratio() const { return observed_max > 0 ? bound / observed_max : 0; }
};

struct MeasuredCosts {
  std::string name;
  std::vector<std::string> loops;
  std::vector<double> cost;  // per count; thousandths, rounded up
  graph::LoopCounts declared, observed;
  std::array<BoundCheck, k_limit_sets> at;  // Limits{} and a cell's
  EnvelopeValidation fit_half, judge_half;
  MeasuredInput worst_input;  // the most expensive input
  std::vector<double> sorted_costs;
  std::int64_t beyond_declared = 0;  // calls in which a loop exceeded its declared maximum
  [[nodiscard]] bool holds() const {
    return at[0].holds() && at[1].holds() && beyond_declared == 0;
  }
};

// Uses the costs of a board (in its counter's unit), or fits an envelope if `board` is null. Throws
// InputError if no envelope exists.
[[nodiscard]] MeasuredCosts costs_of(const KernelObservations& kernel, const BoardKernel* board,
                                     double margin);

[[nodiscard]] double quantile(const std::vector<double>& sorted, double share);

}  // namespace glint
