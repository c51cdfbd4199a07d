// JSON of a background group's counts: the same fields in runs on desktop and companion computer.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "platform/runtime/session/background_group.hpp"

namespace glint {

[[nodiscard]] nlohmann::ordered_json as_json(const BackgroundCounts& counts);

}  // namespace glint
