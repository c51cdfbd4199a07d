// What a run says at its end: a table for a person, summary.json with the same figures, plots.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "platform/cells/cell.hpp"
#include "platform/session/session.hpp"

namespace glint {

[[nodiscard]] nlohmann::ordered_json summary_of(const Cell& cell, const RunPlan& plan,
                                                const SessionResult& result);

void print_table(const nlohmann::ordered_json& summary, const SessionResult& result);

// tip_error.svg, tip_path.svg and frame_to_can.svg in `folder`; their names go to result.files.
void draw_plots(const std::string& folder, SessionResult& result);

// Whether the run's own sums hold: nothing lost without being counted.
[[nodiscard]] bool sums_hold(const SessionResult& result);

}  // namespace glint
