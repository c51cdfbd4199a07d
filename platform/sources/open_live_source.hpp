// Factory of live sources by kind. A new kind adds one line here and one in the CMake list.
#pragma once

#include <memory>
#include <string>

#include "platform/cells/cell.hpp"
#include "platform/sources/live_source.hpp"

namespace glint {

// Returns "dds, hl2ss, shm".
[[nodiscard]] std::string live_kinds();

// Opens the live source named by `[source]`; null for other kinds. The cell takes the lens of the
// frames if it names none. Throws InputError: a run that is not in real time, no lens, and the
// errors of the kind.
[[nodiscard]] std::unique_ptr<LiveSource> open_live_source(Cell& cell, LiveSettings live);

}  // namespace glint
