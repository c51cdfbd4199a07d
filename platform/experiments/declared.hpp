// The parameters of an experiment, written down so that a figure can be traced to them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "platform/experiments/experiment.hpp"

namespace glint {

// JSON: camera, noise, signal, localisation, reference, both methods' gates, frames and seeds.
[[nodiscard]] std::string declared_parameters(const std::vector<ExperimentRun>& runs);

// FNV-1a with 64 bits, as 16 hexadecimal digits: names a set of parameters, protects nothing.
// Source: Fowler, Noll, Vo, The FNV non-cryptographic hash algorithm.
[[nodiscard]] std::string fnv1a_text(std::string_view text);

}  // namespace glint
