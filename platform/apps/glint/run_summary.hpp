// summary.json of a run.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "platform/cells/cell.hpp"
#include "platform/runtime/session/session.hpp"

namespace glint {

[[nodiscard]] nlohmann::ordered_json summary_of(const Cell& cell, const RunSchedule& plan,
                                                const SessionResult& result);

}  // namespace glint
