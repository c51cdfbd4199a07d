// Poses of a CAN log: the frames of each tool and tick, decoded and joined to one row.
#pragma once

#include <string>
#include <vector>

#include "platform/apps/python/rows.hpp"
#include "platform/cells/cell.hpp"

namespace glint::python {

// Reads a log of `candump -L`. The cell names the identifiers, the frame format and the tick's
// period. Skips frames of other messages, remote requests and error frames. Throws InputError:
// file:line for any other line.
[[nodiscard]] std::vector<CanPoseRow> read_can_log(const std::string& path, const Cell& cell);

}  // namespace glint::python
