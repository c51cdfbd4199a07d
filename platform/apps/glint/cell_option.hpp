// Option --config FILE of every command: the cell file; alias --cell.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "platform/cells/cell.hpp"

namespace glint {

void add_cell_option(CLI::App& command, std::string& file,
                     const std::string& what = "cell file; default: the built-in cell");

// Adds the option to each command below `app` that lacks it; such a command only reads and checks
// the file. A script may therefore pass one --config to every command.
void add_cell_check(CLI::App& app);

// Returns the built-in cell for an empty name. Throws InputError as load_cell does.
[[nodiscard]] Cell cell_or_default(const std::string& file);

}  // namespace glint
