// A cell inside a recording: its text and every file it names, so that a recording replays alone.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "platform/cells/cell.hpp"
#include "platform/record/recording.hpp"
#include "platform/record/recording_reader.hpp"

namespace glint {

// "cell.toml"; "tools.json", whose numbers read back to the same bits; "rays.f32", the ray
// table's floats in this machine's byte order (little endian wherever Glint runs), if there is one;
// and the files of `glint calibrate` by the keys that name them, such as "motion.file.toml".
[[nodiscard]] std::vector<Attachment> attachments_of(const Cell& cell);

// What "tools.json" holds; `path` is the recording's. Throws InputError where it is damaged.
[[nodiscard]] ToolSet tools_from_json(std::string_view text, const std::string& path);

// Throws InputError where an attachment is missing or damaged.
[[nodiscard]] Cell recorded_cell(RecordingReader& reader, const std::string& path);

}  // namespace glint
