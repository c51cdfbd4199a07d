// Text rows of the slack of each node, each chain and the system: the growth of bounds up to the
// first missed deadline.
#pragma once

#include <string>

#include "platform/budget/check.hpp"

namespace glint {

// "   +38.0" in percent, from the largest factor; "none": infeasible even with zero times.
[[nodiscard]] std::string shown_slack(const std::optional<double>& factor);

// Rows of the nodes; the copies of a split in one row, scaled together.
[[nodiscard]] std::string node_slack_rows(const CheckResult& result);

[[nodiscard]] std::string slack_table(const CheckResult& result);

}  // namespace glint
