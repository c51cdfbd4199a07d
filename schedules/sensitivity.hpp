// Sensitivity analysis: largest growth of execution times without a missed deadline.
//
// What:     the largest factor on the bounds of selected nodes under which the assessment still
//           holds, by bisection. Responses are monotonic in the factor, so all smaller factors
//           hold, too.
// Cost:     at most k_bisection_steps assessments a question.
// Accuracy: a ten-thousandth of the factor; the returned factor was itself assessed.
// Worst:    no deadline is ever missed: returns k_factor_max.
// Source:   slack as in MAST 1.5 (Gonzalez Harbour et al. 2001): the percentage by which all
//           execution times of a set may grow; negative for a set that misses a deadline.
#pragma once

#include <functional>
#include <optional>

#include "schedules/assessment.hpp"

namespace glint {

inline constexpr int k_bisection_steps = 48;
inline constexpr double k_factor_max = 1000;

// Predicate that selects the scaled nodes, by group and node index.
using IsScaled = std::function<bool(std::size_t group, std::size_t node)>;

// Scales the bounds, rounded up, and the longest slice of a scaled group. `system_too`: also scales
// the operating system's share, as for a slower clock.
[[nodiscard]] TaskModel scaled(const TaskModel& model, double factor, const IsScaled& is_scaled,
                               bool system_too = false);

// Returns nothing if the deadlines are missed even with a factor of 0.
[[nodiscard]] std::optional<double> largest_factor(const std::function<bool(double)>& holds);

[[nodiscard]] std::optional<double> largest_factor(const AnalysisInput& input,
                                                   const IsScaled& is_scaled,
                                                   bool system_too = false);

// 38.0: execution times may grow by 38 %.
[[nodiscard]] inline double slack_percent(double factor) { return 100 * (factor - 1); }

}  // namespace glint
