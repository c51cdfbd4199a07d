// The kinds of recorded frames by name. A new kind is one line here and one in the CMake list.
#pragma once

#include <memory>
#include <string>

#include "platform/cells/cell.hpp"
#include "platform/record/recording_reader.hpp"
#include "platform/session/frame_source.hpp"
#include "platform/sources/live_source.hpp"

namespace glint {

// "folder, hl2ss_file, ...".
[[nodiscard]] std::string recorded_kinds();

// The kind of what stands at a path; empty: none of them.
[[nodiscard]] std::string kind_at(const std::string& path);

// What `[source]` names, for frames of the cell's camera; null for the simulator. `live.duration`
// holds for recorded frames, too. The cell takes the lens that is recorded with the frames where it
// names none. Throws InputError: an unknown
// kind, no path, no lens, a live kind for a run in order, and what the kind's reader and FileSource
// throw.
[[nodiscard]] std::unique_ptr<FrameSource> open_source(Cell& cell, ReadTolerance tolerance = {},
                                                       LiveSettings live = {});

}  // namespace glint
