// --config FILE, the cell file, with --cell as its alias: every command takes it.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "platform/cells/cell.hpp"
#include "platform/record/recording_reader.hpp"

namespace glint {

void add_cell_option(CLI::App& command, std::string& file,
                     const std::string& what = "cell file; default: the built-in cell");

// To each command below `app` without that option: the file is read and checked, no more. A script
// may thus pass one --config to every command.
void add_cell_check(CLI::App& app);

// The built-in cell for an empty name. Throws InputError as load_cell.
[[nodiscard]] Cell cell_or_default(const std::string& file);

// A cell whose [source] is recorded frames: `source` where it is given, of this kind or else by
// what is there. Without a cell file a recording's own cell holds. Throws InputError: nothing
// recorded.
[[nodiscard]] Cell recorded_source_cell(const std::string& source, const std::string& config,
                                        const std::string& kind, ReadTolerance tolerance = {});

}  // namespace glint
