// Formats of `glint path`: the post-processors, the table and the strokes file, by name or by the
// file's suffix.
#pragma once

#include <cstdint>
#include <string>

#include "platform/tools/programming/robot_program.hpp"
#include "platform/tools/programming/strokes_json.hpp"

namespace glint {

enum class ProgramFormat : std::uint8_t { urscript, krl, rapid, ls, csv, json, mcap };

// Names and suffixes: urscript .script, krl .src, rapid .mod, ls .ls, csv .csv, json .json, mcap
// .mcap, in any case. An empty name selects by suffix. Throws InputError for an unknown name or
// suffix.
[[nodiscard]] ProgramFormat program_format(const std::string& name, const std::string& file);

// Name of the program in this file: its stem, since controllers load a program by its file. Foreign
// characters become '_', and a stem that begins with no letter gets the prefix "p_".
[[nodiscard]] std::string program_name(const std::string& file);

// Text of every format except mcap, which is written by write_strokes_recording(). Throws
// InputError for a path, a setting or a name that the format does not allow.
[[nodiscard]] std::string path_text(const StrokesFile& strokes, const ProgramSettings& settings,
                                    ProgramFormat format);

}  // namespace glint
