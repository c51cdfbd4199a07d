#include "schedules/sensitivity.hpp"

#include <cmath>

namespace glint {
namespace {

std::int64_t grown(std::int64_t ns, double factor) {
  return static_cast<std::int64_t>(std::ceil(static_cast<double>(ns) * factor));
}

}  // namespace

TaskModel scaled(const TaskModel& model, double factor, const Grows& grows, bool system_too) {
  TaskModel result = model;
  for (std::size_t g = 0; g < result.groups.size(); ++g) {
    TaskGroup& group = result.groups[g];
    std::size_t changed = 0;
    for (std::size_t n = 0; n < group.nodes.size(); ++n) {
      if (!grows(g, n)) continue;
      group.nodes[n].bound_ns = grown(group.nodes[n].bound_ns, factor);
      ++changed;
    }
    // A slice consists of these nodes: it grows with any of them, and shrinks only with all.
    if (factor > 1 ? changed > 0 : changed == group.nodes.size()) {
      group.longest_slice_ns = grown(group.longest_slice_ns, factor);
    }
  }
  if (system_too) {
    SystemShare& system = result.system;
    system.wake_up_ns = grown(system.wake_up_ns, factor);
    system.interrupt_ns = grown(system.interrupt_ns, factor);
    system.can_write_ns = grown(system.can_write_ns, factor);
    system.core_handover_ns = grown(system.core_handover_ns, factor);
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

std::optional<double> largest_factor(const Question& question, const Grows& grows,
                                     bool system_too) {
  Question asked = question;
  return largest_factor([&](double factor) {
    asked.model = scaled(question.model, factor, grows, system_too);
    return assess(asked).holds();
  });
}

}  // namespace glint
