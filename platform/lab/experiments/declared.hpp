// Declared parameters of an experiment as JSON, with a hash, so that a figure is traceable to them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "platform/lab/experiments/experiment.hpp"

namespace glint {

// JSON: camera, noise, signal, localisation, reference, the baseline's gates, frames and random
// seeds.
[[nodiscard]] std::string declared_parameters(const std::vector<ExperimentRun>& runs);

// 64-bit FNV-1a hash as 16 hexadecimal digits: identifies a set of parameters; not cryptographic.
// Source:   Fowler, Noll, Vo, The FNV non-cryptographic hash algorithm.
[[nodiscard]] std::string fnv1a_text(std::string_view text);

}  // namespace glint
