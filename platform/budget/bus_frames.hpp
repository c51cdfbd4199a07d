// Messages on a cell's CAN bus: Glint's own, and those of other nodes.
#pragma once

#include <string>
#include <vector>

#include "platform/cells/cell.hpp"
#include "schedules/can_response.hpp"

namespace glint {

// Glint's messages: poses, heartbeat, time and emergencies for `tools` tools, from one FIFO queue,
// as in SocketCAN. Their deadline is the tick's.
[[nodiscard]] std::vector<CanMessage> own_frames_of(const Cell& cell, int tools);

// Reads a file of other nodes' frames (TOML):
//
//   [[frame]]
//   name = "joint torque"
//   identifier = 0x120
//   extended = false           # the default, as for fd and bit_rate_switch
//   bytes = 8
//   period_ms = 4
//   jitter_ms = 0.2            # default: 0
//   deadline_ms = 4            # default: the period
//   node = "drive"             # sender; frames of one node share a queue
//   queue = "priority"         # or "fifo": one kind per node
//
// Throws InputError: file:line, what was found, what was expected. Rejects an identifier that Glint
// uses.
[[nodiscard]] std::vector<CanMessage> foreign_frames(const std::string& file,
                                                     const std::vector<CanMessage>& own);
[[nodiscard]] std::vector<CanMessage> foreign_frames_from_text(const std::string& text,
                                                               const std::string& file,
                                                               const std::vector<CanMessage>& own);

}  // namespace glint
