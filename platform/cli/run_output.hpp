// What left of a run and what was lost: the rows that lead the table, their JSON, the exit code.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "platform/cells/cell.hpp"
#include "platform/session/session.hpp"

namespace glint {

// At most this part of the ticks may lack a measurement because the source was late.
inline constexpr double k_source_late_max = 0.01;

// By tool: ticks that left over CAN, by state, and the longest gaps.
[[nodiscard]] nlohmann::ordered_json output_of(const Cell& cell, const SessionResult& result);
// Of recorded frames: stamps skipped, gaps, frames without head pose or not readable.
[[nodiscard]] nlohmann::ordered_json source_json(const SessionResult& result);
[[nodiscard]] nlohmann::ordered_json losses_json(const SessionResult& result);

// Name and value of each row; `summary` holds output_of().
[[nodiscard]] std::vector<std::pair<std::string, std::string>> output_rows(
    const nlohmann::ordered_json& summary, const SessionResult& result);

// Why the run ends with 1, one line each: output lost, sums that do not hold, a source that is too
// slow, not one pose.
[[nodiscard]] std::vector<std::string> failures_of(const SessionResult& result);

}  // namespace glint
