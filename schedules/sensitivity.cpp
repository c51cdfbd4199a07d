#include "schedules/sensitivity.hpp"

#include <cmath>

namespace glint {
namespace {

std::int64_t scaled_up(std::int64_t ns, double factor) {
  return static_cast<std::int64_t>(std::ceil(static_cast<double>(ns) * factor));
}

}  // namespace

TaskModel scaled(const TaskModel& model, double factor, const IsScaled& is_scaled,
                 bool system_too) {
  TaskModel result = model;
  for (std::size_t g = 0; g < result.groups.size(); ++g) {
    TaskGroup& group = result.groups[g];
    std::size_t changed = 0;
    for (std::size_t n = 0; n < group.nodes.size(); ++n) {
      if (!is_scaled(g, n)) continue;
      group.nodes[n].bound_ns = scaled_up(group.nodes[n].bound_ns, factor);
      ++changed;
    }
    // A slice consists of these nodes: it grows with any of them, and shrinks only with all.
    if (factor > 1 ? changed > 0 : changed == group.nodes.size()) {
      group.longest_slice_ns = scaled_up(group.longest_slice_ns, factor);
    }
  }
  if (system_too) {
    SystemShare& system = result.system;
    system.wake_up_ns = scaled_up(system.wake_up_ns, factor);
    system.interrupt_ns = scaled_up(system.interrupt_ns, factor);
    system.can_write_ns = scaled_up(system.can_write_ns, factor);
    system.inter_core_delay_ns = scaled_up(system.inter_core_delay_ns, factor);
  }
  return result;
}

std::optional<double> largest_factor(const std::function<bool(double)>& holds) {
  if (holds(k_factor_max)) return k_factor_max;
  if (!holds(0)) return std::nullopt;
  double good = 0, bad = k_factor_max;
  for (int step = 0; step < k_bisection_steps && bad - good > 1e-4 * (good + 1e-3); ++step) {
    // Most factors are near 1: bisect by the geometric mean once a good factor is known.
    const double middle = good > 0 ? std::sqrt(good * bad) : bad > 1 ? 1 : bad / 2;
    (holds(middle) ? good : bad) = middle;
  }
  return good;
}

std::optional<double> largest_factor(const AnalysisInput& input, const IsScaled& is_scaled,
                                     bool system_too) {
  AnalysisInput scaled_input = input;
  return largest_factor([&](double factor) {
    scaled_input.model = scaled(input.model, factor, is_scaled, system_too);
    return assess(scaled_input).holds();
  });
}

}  // namespace glint
