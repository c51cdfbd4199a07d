// Tools among strays, and tools that look alike: whether each is found, and under its own name.
//
// Rendered frames through the tracker's graph itself: five tools in moving hands among 0 to 200
// balls of a marker's size, a cell for as many blobs as there may be and the built-in steps of the
// search; then two tools that a cell only just takes, and two that it knows apart, in hands that
// pass each other. Tools of equal sides are to be refused when a cell is read. What counts as
// visible, gross and swapped: clutter_tally.hpp. The published method beside it sees the first
// frames of each case, a tracker a tool.
#pragma once

#include "platform/experiments/case_list.hpp"

namespace glint {

[[nodiscard]] CaseList run_clutter(const CaseOptions& options);

}  // namespace glint
