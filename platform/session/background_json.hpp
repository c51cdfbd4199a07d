// What a background did, as JSON: the same fields from a desktop's run and a board's.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "platform/session/background_group.hpp"

namespace glint {

[[nodiscard]] nlohmann::ordered_json as_json(const BackgroundCounts& counts);

}  // namespace glint
