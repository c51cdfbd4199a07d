// Detection and identification of tools among false markers, and of tools with similar geometry.
//
// Rendered frames pass through the tracker's graph: five tools in moving hands among 0 to 200 balls
// of a marker's size, with a cell of the maximum number of blobs and the built-in search steps.
// Then two tools that a cell just accepts, and two that it distinguishes, in hands that pass each
// other. A cell with tools of equal sides must be refused. clutter_tally.hpp defines trackable,
// gross and swapped. The baseline processes the first frames of each case, one tracker per tool.
#pragma once

#include "platform/lab/experiments/case_list.hpp"

namespace glint {

[[nodiscard]] CaseList run_clutter(const CaseOptions& options);

}  // namespace glint
