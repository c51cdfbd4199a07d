// The parts of a cell file that say how the headset knows where it is: by itself, and by a body
// that does not move.
#pragma once

#include "platform/cells/cell.hpp"
#include "platform/cells/toml_reader.hpp"

namespace glint {

// reference = "NAME": one of the tools that were read before.
void read_reference(TomlReader& root, Cell& cell);

// [headset]: how far its own localisation is off; null: as kernels/motion/head_anchor.hpp has it.
void read_headset(const toml::table* table, Cell& cell);

}  // namespace glint
