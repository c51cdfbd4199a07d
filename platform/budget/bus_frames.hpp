// What is on a cell's CAN bus: what Glint sends itself, and what others do.
#pragma once

#include <string>
#include <vector>

#include "platform/cells/cell.hpp"
#include "schedules/can_response.hpp"

namespace glint {

// Poses, heartbeat, time and emergencies for `tools` tools, from one first-in first-out queue, as
// SocketCAN has it. Their deadline is the tick's.
[[nodiscard]] std::vector<CanMessage> own_frames_of(const Cell& cell, int tools);

// A file of other nodes' frames (TOML):
//
//   [[frame]]
//   name = "joint torque"
//   identifier = 0x120
//   extended = false           # the default, as for fd and bit_rate_switch
//   bytes = 8
//   period_ms = 4
//   jitter_ms = 0.2            # 0 where left out
//   deadline_ms = 4            # the period where left out
//   node = "drive"             # who sends it; one node's frames share a queue
//   queue = "priority"         # or "fifo": one kind a node
//
// Throws InputError: file:line, what was found, what was expected. An identifier that Glint uses
// itself is refused.
[[nodiscard]] std::vector<CanMessage> foreign_frames(const std::string& file,
                                                     const std::vector<CanMessage>& own);
[[nodiscard]] std::vector<CanMessage> foreign_frames_from_text(const std::string& text,
                                                               const std::string& file,
                                                               const std::vector<CanMessage>& own);

}  // namespace glint
