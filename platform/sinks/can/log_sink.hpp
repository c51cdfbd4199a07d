// CAN sink that writes a `candump -L` log file, for machines without a bus.
#pragma once

#include "platform/sinks/can/can_sink.hpp"

namespace glint {

// See open_can_sink. Frames pass through a bounded ring to a thread that formats and writes them.
// The file is FILE.part (part_file.hpp) until the sink is closed, then it is renamed; a device or
// pipe (/dev/stdout) is written directly. A full disk ends the log at its last complete line; later
// frames count as failed.
[[nodiscard]] std::unique_ptr<CanSink> open_log_sink(const std::string& file,
                                                     const CanSinkOptions& options);

}  // namespace glint
