// Stores a cell in a recording and reads it back: its text and every file it names, so that the
// recording can be replayed without other files.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "platform/cells/cell.hpp"
#include "platform/sinks/record/recording.hpp"
#include "platform/sinks/record/recording_reader.hpp"

namespace glint {

// Attachments: "cell.toml"; "tools.json", whose numbers are read back bit-identically; "rays.f32",
// the ray table's floats, if there is one; and the files of `glint calibrate`, named by their keys,
// such as "motion.file.toml". Byte order of "rays.f32": this machine's (little endian on all
// supported ones).
[[nodiscard]] std::vector<Attachment> attachments_of(const Cell& cell);

// Reads "tools.json"; `path` is the recording's. Throws InputError if it is damaged.
[[nodiscard]] ToolSet tools_from_json(std::string_view text, const std::string& path);

// Throws InputError if an attachment is missing or damaged.
[[nodiscard]] Cell recorded_cell(RecordingReader& reader, const std::string& path);

}  // namespace glint
