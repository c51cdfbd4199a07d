#include "platform/budget/measure/cost_fit.hpp"

#include <algorithm>
#include <cmath>

#include "platform/input_error.hpp"

namespace glint {
namespace {

// Rounds up to the resolution of a board file, so that writing preserves the envelope.
double rounded_up(double cost) {
  return cost > 0 ? std::ceil(cost * 1000 - 1e-6) / 1000 : 0;  // avoids a negative zero
}

}  // namespace

double quantile(const std::vector<double>& sorted, double share) {
  if (sorted.empty()) return 0;
  const double rank = std::ceil(share * static_cast<double>(sorted.size()));
  const auto index = static_cast<std::size_t>(std::max(1.0, rank)) - 1;
  return sorted[std::min(index, sorted.size() - 1)];
}

MeasuredCosts costs_of(const KernelObservations& kernel, const BoardKernel* board, double margin) {
  std::array<std::vector<ObservedCall>, 2> half;  // 0: fitted, 1: judged
  MeasuredCosts result;
  result.name = kernel.name;
  result.loops = kernel.loops;
  result.declared = kernel.worst[0];
  std::array<ProblemSize, k_limit_sets> sizes;  // from the fitted half
  for (std::size_t i = 0; i < k_limit_sets; ++i) sizes[i].maximum = kernel.worst[i];
  double cost_max = -1;
  for (const Observation& seen : kernel.calls) {
    const bool fits = is_in_fit_half(seen.input);
    half[fits ? 0 : 1].push_back(seen.call);
    ProblemSize& size = sizes[seen.input.limits];
    if (fits) size.cost_max = std::max(size.cost_max, seen.call.cost);
    result.sorted_costs.push_back(seen.call.cost);
    for (std::size_t j = 0; j < graph::k_loops_max; ++j) {
      result.observed[j] = std::max(result.observed[j], seen.call.counts[j]);
    }
    const graph::LoopCounts& declared = kernel.worst[seen.input.limits];
    result.beyond_declared += graph::within(seen.call.counts, declared) ? 0 : 1;
    double& most = result.at[seen.input.limits].observed_max;
    most = std::max(most, seen.call.cost);
    if (seen.call.cost > cost_max) {
      cost_max = seen.call.cost;
      result.worst_input = seen.input;
    }
  }
  std::sort(result.sorted_costs.begin(), result.sorted_costs.end());

  Envelope envelope;
  if (board != nullptr) {
    for (std::size_t j = 0; j < board->cost.size(); ++j) envelope.cost[j] = board->cost[j];
  } else {
    envelope = fit_envelope(
        {half[0], balanced_weights(half[0], sizes), static_cast<int>(kernel.loops.size()), margin});
    if (!envelope) {
      throw InputError(kernel.name +
                       ": no costs can be fitted: " + std::string(name_of(envelope.fault)));
    }
    for (double& cost : envelope.cost) cost = rounded_up(cost);
  }
  result.cost.assign(envelope.cost.begin(),
                     envelope.cost.begin() + static_cast<std::ptrdiff_t>(kernel.loops.size()));
  for (std::size_t i = 0; i < k_limit_sets; ++i) {
    result.at[i].bound = cost_of(envelope, kernel.worst[i]);
  }
  result.fit_half = validate(envelope, half[0]);
  result.judge_half = validate(envelope, half[1]);
  return result;
}

}  // namespace glint
