// Extracts the path from a recording: merges the poses of a tool and the button events in time
// order.
#pragma once

#include <string>
#include <vector>

#include "platform/sinks/record/recording_reader.hpp"
#include "platform/tools/programming/path_capture.hpp"

namespace glint {

struct RecordedPathOptions {
  std::string tool;                  // the tool's name; empty: the first in the recording
  std::vector<ButtonEvent> presses;  // replace the recording's events; empty: use those
  CaptureSettings capture;
  ReadTolerance tolerance;
};

struct RecordedPath {
  DrawnPath path;
  CaptureCounts counts;
  std::string tool;
  std::int64_t events = 0;
  Duration unix_offset;    // plus a point's time: time since 1970 (UTC)
  RecordingLosses losses;  // only if the tolerance allows losses
};

// Throws InputError: no recording, no such tool, no event, or no accepted pose.
[[nodiscard]] RecordedPath recorded_path(const std::string& recording,
                                         const RecordedPathOptions& options);

}  // namespace glint
