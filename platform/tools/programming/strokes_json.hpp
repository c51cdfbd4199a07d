// Strokes file: a drawn path as JSON, with names and covariances (platform/doc/strokes_file.md).
#pragma once

#include <string>

#include "platform/tools/programming/path.hpp"

namespace glint {

struct StrokesFile {
  DrawnPath path;          // with unique names
  std::string tool{};      // the pen's name
  Duration unix_offset{};  // plus a point's time: time since 1970 (UTC)
};

// Numbers read back to the same bits.
[[nodiscard]] std::string strokes_json(const StrokesFile& strokes);

// `from` names the file in errors. Throws InputError with the place, for text that is no JSON, an
// unknown, missing or duplicate key, another version or frame, and a value of another type or out
// of range.
[[nodiscard]] StrokesFile strokes_of_json(const std::string& text, const std::string& from);
[[nodiscard]] StrokesFile read_strokes(const std::string& file);

}  // namespace glint
