// JSON of a source's report: the same fields in runs on desktop and companion computer.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "platform/runtime/session/frame_source.hpp"

namespace glint {

[[nodiscard]] nlohmann::ordered_json as_json(const SourceReport& report);

}  // namespace glint
