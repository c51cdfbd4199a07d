// The path in a recording: its tool's poses and the button's events, put in the order of their
// time.
#pragma once

#include <string>
#include <vector>

#include "platform/programming/path_capture.hpp"
#include "platform/record/recording_reader.hpp"

namespace glint {

struct RecordedPathOptions {
  std::string tool;                  // its name; empty: the recording's first
  std::vector<ButtonEvent> presses;  // in place of the recording's events; empty: those
  CaptureSettings capture;
  ReadTolerance tolerance;
};

struct RecordedPath {
  DrawnPath path;
  CaptureCounts counts;
  std::string tool;
  std::int64_t events = 0;
  Duration unix_offset;    // added to a point's time it gives time since 1970 (UTC)
  RecordingLosses losses;  // only where the tolerance allows them
};

// Throws InputError: no recording, no such tool, no event at all, or nothing that could be taken.
[[nodiscard]] RecordedPath recorded_path(const std::string& recording,
                                         const RecordedPathOptions& options);

}  // namespace glint
