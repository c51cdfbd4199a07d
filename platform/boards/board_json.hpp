// A board's figures as JSON: what was observed in a run, and the operating system's share.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "platform/boards/board_run.hpp"
#include "platform/boards/system_share.hpp"

namespace glint {

[[nodiscard]] nlohmann::ordered_json as_json(const BoardResult& result);
// Includes "system": the rows of schedules/task_model.hpp's SystemShare, each the largest observed,
// but the smallest gap.
[[nodiscard]] nlohmann::ordered_json as_json(const SystemShareFigures& figures);

}  // namespace glint
