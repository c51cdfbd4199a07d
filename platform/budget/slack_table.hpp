// How much slower each node, each chain and the system may become before a deadline is missed, as
// rows for a terminal.
#pragma once

#include <string>

#include "platform/budget/check.hpp"

namespace glint {

// "   +38.0" in percent, from the largest factor; "none": not even work without time would do.
[[nodiscard]] std::string shown_slack(const std::optional<double>& factor);

// The nodes, a split's copies in one row: they grow together.
[[nodiscard]] std::string node_slack_rows(const CheckResult& result);

[[nodiscard]] std::string slack_table(const CheckResult& result);

}  // namespace glint
