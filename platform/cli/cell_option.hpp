// --config FILE, the cell file, with --cell as its alias: every command takes it.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "platform/cells/cell.hpp"

namespace glint {

void add_cell_option(CLI::App& command, std::string& file,
                     const std::string& what = "cell file; default: the built-in cell");

// To each command below `app` without that option: the file is read and checked, no more. A script
// may thus pass one --config to every command.
void add_cell_check(CLI::App& app);

// The built-in cell for an empty name. Throws InputError as load_cell.
[[nodiscard]] Cell cell_or_default(const std::string& file);

}  // namespace glint
