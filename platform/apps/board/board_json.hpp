// JSON of a companion computer's figures: observations of a run, and the operating system's share.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "platform/apps/board/board_run.hpp"
#include "platform/apps/board/system_share.hpp"

namespace glint {

[[nodiscard]] nlohmann::ordered_json as_json(const CompanionResult& result);
// Includes "system", the fields of SystemShare (schedules/task_model.hpp): each the observed
// maximum, except the gap, which is the minimum.
[[nodiscard]] nlohmann::ordered_json as_json(const SystemShareFigures& figures);

}  // namespace glint
