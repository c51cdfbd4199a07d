// Outputs and losses of a run: the leading rows of the table, their JSON, the exit code's reasons.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "platform/cells/cell.hpp"
#include "platform/runtime/session/session.hpp"

namespace glint {

// Largest fraction of the ticks that may lack a measurement because the source was late.
inline constexpr double k_source_late_max = 0.01;

// Per tool: ticks sent over CAN, by state, and the longest gaps.
[[nodiscard]] nlohmann::ordered_json output_of(const Cell& cell, const SessionResult& result);
[[nodiscard]] nlohmann::ordered_json losses_json(const SessionResult& result);

// Returns name and value of each row; `summary` contains output_of().
[[nodiscard]] std::vector<std::pair<std::string, std::string>> output_rows(
    const nlohmann::ordered_json& summary, const SessionResult& result);

// Returns the reasons for exit code 1, one line each: lost output, DDS sample counts that do not
// add up, a source that is too slow, no pose.
[[nodiscard]] std::vector<std::string> failures_of(const SessionResult& result);

}  // namespace glint
