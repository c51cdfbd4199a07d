// Reader of [can] of a cell: bus for the output poses, and frame of the input buttons.
#pragma once

#include "platform/cells/cell.hpp"
#include "platform/cells/toml_reader.hpp"

namespace glint {

// Requires the tools: each uses 16 identifiers. table: null keeps the defaults. Throws InputError,
// also if Glint itself sends the identifier of the buttons.
void read_can(const toml::table* table, Cell& cell);

}  // namespace glint
