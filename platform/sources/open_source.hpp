// The kinds of recorded frames by name. A new kind is one line here and one in the CMake list.
#pragma once

#include <memory>
#include <string>

#include "platform/cells/cell.hpp"
#include "platform/record/recording_reader.hpp"
#include "platform/session/frame_source.hpp"

namespace glint {

// "folder, recording".
[[nodiscard]] std::string recorded_kinds();

// Of what `[source]` names, for frames of the cell's camera. Throws InputError: an unknown kind, no
// path, and what the kind's reader and FileSource throw.
[[nodiscard]] std::unique_ptr<FrameSource> open_recorded(const Cell& cell,
                                                         ReadTolerance tolerance = {});

}  // namespace glint
