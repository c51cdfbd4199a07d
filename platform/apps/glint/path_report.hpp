// Table and figures of `glint path`.
#pragma once

#include <nlohmann/json.hpp>

#include "platform/tools/programming/recorded_path.hpp"

namespace glint {

// A line for each element.
void print_elements(const DrawnPath& path);

// Poses used and left out, their standard deviations and losses.
void print_capture(const RecordedPath& drawn, double spacing_m);

[[nodiscard]] nlohmann::ordered_json path_figures(const RecordedPath& drawn);

}  // namespace glint
