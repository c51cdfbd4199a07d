// An experiment's figures as JSON, as a table for a terminal, and as plots.
#pragma once

#include <string>
#include <vector>

#include "platform/experiments/experiment.hpp"

namespace glint {

// {"experiment": .., "published": {..}, "seed": {..}, "glint": {..}, ..}; see README.md. A figure
// that the publication does not state is null.
[[nodiscard]] std::string experiment_json(const ExperimentResult& result);

// Published, seed and Glint side by side, with the definition of the figures underneath.
[[nodiscard]] std::string experiment_table(const ExperimentResult& result);

// Writes NAME_position.svg, NAME_angle.svg and NAME_path.svg into the folder, NAME being static or
// dynamic; returns their paths. Throws InputError where it cannot.
std::vector<std::string> write_experiment_plots(const ExperimentResult& result,
                                                const std::string& folder);

[[nodiscard]] std::string name_of(ExperimentKind kind);

}  // namespace glint
