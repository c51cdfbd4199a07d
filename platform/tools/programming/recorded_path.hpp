// Extracts the path from a recording: merges the poses of a tool and the button events in time
// order.
//
// The poses are smoothed over the measured frames of each stroke (smoothed_motion.hpp), which a
// replay of the recording computes again. A recording of level outputs has no frames: its poses are
// those sent at the ticks.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "platform/sinks/record/recording_reader.hpp"
#include "platform/tools/programming/path_capture.hpp"

namespace glint {

enum class PathPoses : std::uint8_t {
  smoothed,  // from the frames, where the recording has them
  as_sent    // live predictions, at the ticks
};

struct RecordedPathOptions {
  std::string tool;                  // the tool's name; empty: the first in the recording
  std::vector<ButtonEvent> presses;  // replace the recording's events; empty: use those
  CaptureSettings capture;
  ReadTolerance tolerance;
  PathPoses poses = PathPoses::smoothed;
};

struct RecordedPath {
  DrawnPath path;
  CaptureCounts counts;
  std::string tool;
  std::int64_t events = 0;
  PathPoses poses = PathPoses::as_sent;
  std::int64_t frames = 0;             // measured frames while draw was held; 0 as_sent
  std::int64_t replay_mismatches = 0;  // output records that the replay computed differently
  Duration unix_offset;                // plus a point's time: time since 1970 (UTC)
  RecordingLosses losses;              // only if the tolerance allows losses
};

// Throws InputError: no recording, no such tool, no event, or no accepted pose.
[[nodiscard]] RecordedPath recorded_path(const std::string& recording,
                                         const RecordedPathOptions& options);

}  // namespace glint
