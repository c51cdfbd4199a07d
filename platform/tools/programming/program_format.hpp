// Formats of `glint path`: the post-processors and the table, by name or by the file's suffix.
#pragma once

#include <cstdint>
#include <string>

#include "platform/tools/programming/robot_program.hpp"

namespace glint {

enum class ProgramFormat : std::uint8_t { urscript, krl, rapid, ls, csv };

// Names and suffixes: urscript .script, krl .src, rapid .mod, ls .ls, csv .csv, in any case. An
// empty name selects by suffix. Throws InputError for an unknown name or suffix.
[[nodiscard]] ProgramFormat program_format(const std::string& name, const std::string& file);

// Name of the program in this file: its stem, since controllers load a program by its file. Foreign
// characters become '_', and a stem that begins with no letter gets the prefix "p_".
[[nodiscard]] std::string program_name(const std::string& file);

// Throws InputError for a path, a setting or a name that the format does not allow.
[[nodiscard]] std::string path_text(const DrawnPath& path, const ProgramSettings& settings,
                                    ProgramFormat format);

}  // namespace glint
