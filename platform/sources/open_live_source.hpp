// The kinds of live frames by name. A new kind is one line here and one in the CMake list.
#pragma once

#include <memory>
#include <string>

#include "platform/cells/cell.hpp"
#include "platform/sources/live_source.hpp"

namespace glint {

// "dds, shm".
[[nodiscard]] std::string live_kinds();

// What `[source]` names; null: none of these kinds. The cell takes the lens that comes with the
// frames where it names none. Throws InputError: a run that is not in real time, no lens, and what
// the kind throws.
[[nodiscard]] std::unique_ptr<LiveSource> open_live_source(Cell& cell, LiveSettings live);

}  // namespace glint
