// The section [can] of a cell file: the bus that poses go to, and the frame that buttons come by.
#pragma once

#include "platform/cells/cell.hpp"
#include "platform/cells/toml_reader.hpp"

namespace glint {

// Its tools are read: each has 16 identifiers of its own. Throws InputError, also where the
// buttons' identifier is one that Glint itself sends with; null: the defaults stand.
void read_can(const toml::table* table, Cell& cell);

}  // namespace glint
