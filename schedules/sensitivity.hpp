// How much slower something may become before a deadline is missed.
//
// What:     the largest factor on some of the nodes' bounds under which an assessment still holds,
//           by bisection: bounds only ever grow with the factor, so what holds below it holds.
// Cost:     at most k_bisection_steps assessments a question.
// Accuracy: a ten-thousandth of the factor; the factor given is one that was seen to hold.
// Worst:    nothing is ever missed: then k_factor_max is given.
// Source:   slack as in MAST 1.5 (Gonzalez Harbour et al. 2001): the percentage by which all
//           execution times of a set may grow; for a set that misses a deadline it is negative.
#pragma once

#include <functional>
#include <optional>

#include "schedules/assessment.hpp"

namespace glint {

inline constexpr int k_bisection_steps = 48;
inline constexpr double k_factor_max = 1000;

// Which nodes grow: by group and node index.
using Grows = std::function<bool(std::size_t group, std::size_t node)>;

// Every bound rounded up, the longest slice of a group that grows too. `system_too`: the operating
// system's share grows alike, as by a slower clock.
[[nodiscard]] TaskModel scaled(const TaskModel& model, double factor, const Grows& grows,
                               bool system_too = false);

// Nothing where not even work that takes no time would be in time.
[[nodiscard]] std::optional<double> largest_factor(const std::function<bool(double)>& holds);

[[nodiscard]] std::optional<double> largest_factor(const Question& question, const Grows& grows,
                                                   bool system_too = false);

// 38.0: may grow by 38 %.
[[nodiscard]] inline double slack_percent(double factor) { return 100 * (factor - 1); }

}  // namespace glint
