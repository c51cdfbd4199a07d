// Reports of an experiment: JSON, a table for a terminal, and SVG plots.
#pragma once

#include <string>
#include <vector>

#include "platform/lab/experiments/experiment.hpp"

namespace glint {

// Returns {"experiment": .., "published": {..}, "baseline": {..}, "glint": {..}, ..}; see
// README.md. A figure that the publication does not state is null.
[[nodiscard]] std::string experiment_json(const ExperimentResult& result);

// Returns published, baseline and Glint figures side by side, with their definitions below.
[[nodiscard]] std::string experiment_table(const ExperimentResult& result);

// Writes NAME_position.svg, NAME_angle.svg and NAME_path.svg into the folder; NAME is static or
// dynamic. Returns their paths. Throws InputError if a file cannot be written.
std::vector<std::string> write_experiment_plots(const ExperimentResult& result,
                                                const std::string& folder);

[[nodiscard]] std::string name_of(ExperimentKind kind);

}  // namespace glint
