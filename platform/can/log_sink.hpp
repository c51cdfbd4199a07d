// Frames to a file in `candump -L` format: for every machine without a bus.
#pragma once

#include "platform/can/can_sink.hpp"

namespace glint {

// See open_can_sink. Frames go through a bounded ring to a thread that formats and writes them. The
// file appears under its own name when the sink is closed, until then it is FILE.part
// (part_file.hpp); a device or pipe (/dev/stdout) is written directly. A full disk ends the log at
// its last whole line; frames from then on count as failed.
[[nodiscard]] std::unique_ptr<CanSink> open_log_sink(const std::string& file,
                                                     const CanSinkOptions& options);

}  // namespace glint
