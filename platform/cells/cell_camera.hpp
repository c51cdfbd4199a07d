// Reader of [camera] of a cell: a preset, overrides of its values, and the lens.
#pragma once

#include "platform/cells/cell.hpp"
#include "platform/cells/cell_files.hpp"
#include "platform/cells/toml_reader.hpp"

namespace glint {

// Throws InputError: file:line: key, found, expected.
void read_camera(const toml::table* table, Cell& cell, const CellFileReader& files);

}  // namespace glint
