#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "platform/budget/measure/measure_result.hpp"

namespace glint {
namespace {

constexpr int k_bins = 40;

nlohmann::ordered_json histogram(const std::vector<double>& sorted) {
  const double low = sorted.empty() ? 0 : sorted.front();
  const double high = sorted.empty() ? 0 : sorted.back();
  const double width = high > low ? (high - low) / k_bins : 1;
  std::vector<int> counts(k_bins, 0);
  for (const double cost : sorted) {
    const int bin = std::min(k_bins - 1, static_cast<int>((cost - low) / width));
    ++counts[static_cast<std::size_t>(bin)];
  }
  return {{"low", low}, {"width", width}, {"counts", counts}};
}

nlohmann::ordered_json kernel_json(const MeasuredCosts& kernel) {
  nlohmann::ordered_json loops = nlohmann::ordered_json::array();
  for (std::size_t j = 0; j < kernel.loops.size(); ++j) {
    loops.push_back({{"name", kernel.loops[j]},
                     {"declared", kernel.declared[j]},
                     {"observed", kernel.observed[j]},
                     {"cost", kernel.cost[j]}});
  }
  const std::vector<double>& sorted = kernel.sorted_costs;
  const BoundCheck& largest = kernel.at[0];
  const BoundCheck& cell = kernel.at[1];
  return {{"name", kernel.name},
          {"bound", largest.bound},
          {"observed_max", largest.observed_max},
          {"ratio", largest.ratio()},
          {"inputs", sorted.size()},
          {"beyond_declared", kernel.beyond_declared},
          {"worst_input",
           {{"kind", name_of(kernel.worst_input.kind)},
            {"number", kernel.worst_input.number},
            {"limits", kernel.worst_input.limits == 0 ? "largest" : "cell"}}},
          {"cell",
           {{"bound", cell.bound}, {"observed_max", cell.observed_max}, {"ratio", cell.ratio()}}},
          {"fit_half", {{"inputs", kernel.fit_half.calls}, {"above", kernel.fit_half.above}}},
          {"judge_half",
           {{"inputs", kernel.judge_half.calls},
            {"above", kernel.judge_half.above},
            {"worst_excess_percent", kernel.judge_half.worst_excess_percent}}},
          {"loops", loops},
          {"percentiles",
           {{"p50", quantile(sorted, 0.5)},
            {"p99", quantile(sorted, 0.99)},
            {"p99_9", quantile(sorted, 0.999)},
            {"max", sorted.empty() ? 0 : sorted.back()}}},
          {"histogram", histogram(sorted)}};
}

}  // namespace

nlohmann::ordered_json measurement_json(const Measurement& measurement) {
  nlohmann::ordered_json kernels = nlohmann::ordered_json::array();
  for (const MeasuredCosts& kernel : measurement.kernels) kernels.push_back(kernel_json(kernel));
  nlohmann::ordered_json interference = nlohmann::ordered_json::array();
  for (const InterferenceFactor& one : measurement.interference) {
    interference.push_back({{"load", one.load}, {"kernel", one.kernel}, {"factor", one.factor}});
  }
  return {{"board", measurement.board},
          {"build", measurement.build},
          {"machine", measurement.machine},
          {"count", measurement.count_instructions ? "instructions" : "time"},
          {"unit", measurement.unit()},
          {"arch", measurement.arch},
          {"cache", measurement.cache},
          {"compiler", measurement.build},
          {"commit_or_version", measurement.version},
          {"kernels", kernels},
          {"interference", interference}};
}

}  // namespace glint
