// Factory of recorded sources by kind. A new kind adds one line here and one in the CMake list.
#pragma once

#include <memory>
#include <string>

#include "platform/cells/cell.hpp"
#include "platform/runtime/session/frame_source.hpp"
#include "platform/sinks/record/recording_reader.hpp"
#include "platform/sources/live_source.hpp"

namespace glint {

// Returns "folder, hl2ss_file, ...".
[[nodiscard]] std::string recorded_kinds();

// Returns the kind of the file or folder at `path`; empty if unknown.
[[nodiscard]] std::string kind_at(const std::string& path);

// Opens the source named by `[source]`, for frames of the cell's camera; null for the simulator.
// `live.duration` also limits recorded frames. The cell takes the lens recorded with the frames if
// it names none. Throws InputError: an unknown kind, no path, no lens, a live kind for a run in
// order, and the errors of the kind's reader and of FileSource.
[[nodiscard]] std::unique_ptr<FrameSource> open_source(Cell& cell, ReadTolerance tolerance = {},
                                                       LiveSettings live = {});

}  // namespace glint
