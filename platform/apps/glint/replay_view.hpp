// glint replay --view: the messages of a recording to a live view, in real time.
#pragma once

#include <cstdint>
#include <string>

#include "platform/runtime/session/replay.hpp"
#include "platform/sinks/view/foxglove_server.hpp"

namespace glint {

struct ViewedRecording {
  std::uint64_t messages = 0;  // passed to the view
  std::uint64_t skipped = 0;   // of another encoding than CDR
  double seconds = 0;          // of the recording
  bool stopped = false;        // by a signal, before the end
  bool lost = false;           // the file is damaged or truncated
  FoxgloveCounts view;
};

// Waits for the first client, then passes each message on when its log time is due; `speed` 2 takes
// half the time. Ends with the recording or with a signal. Throws InputError for an unreadable
// file.
[[nodiscard]] ViewedRecording view_recording(const std::string& path,
                                             const ReadTolerance& tolerance,
                                             const FoxgloveSettings& settings, double speed);

}  // namespace glint
