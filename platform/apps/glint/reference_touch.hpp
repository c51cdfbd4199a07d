// glint reference --touch: pose of a robot from touches of known points with the pen.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "platform/apps/glint/reference_inputs.hpp"

namespace glint {

void add_touch_options(CLI::App& command, TouchArguments& touch);

// Prints the pose and its [robot] of a cell; writes the figures if `json` names a file. Returns the
// exit code: 0 accepted, 1 refused or read from a damaged recording.
[[nodiscard]] int run_touch(const TouchArguments& touch, const std::string& json);

}  // namespace glint
