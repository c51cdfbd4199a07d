// Readers of the headset's localisation in a cell: its own noise, and a static reference tool.
#pragma once

#include "platform/cells/cell.hpp"
#include "platform/cells/toml_reader.hpp"

namespace glint {

// reference = "NAME": requires one of the tools read before.
void read_reference(TomlReader& root, Cell& cell);

// [headset]: noise of its own localisation. null: defaults of
// kernels/motion/head_drift_correction.hpp.
void read_headset(const toml::table* table, Cell& cell);

}  // namespace glint
