// Deterministic replay of a recording: recomputes its output records and compares them byte for
// byte.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "platform/runtime/session/tracked_frame.hpp"
#include "platform/sinks/record/recording_reader.hpp"

namespace glint {

struct ReplayOptions {
  int workers = 1;  // 1 or 2: the same bytes
  ReadTolerance tolerance;
  std::function<void(double seconds)> progress;  // position in the recording
  // Called after each frame that was tracked in time; the robot's pose is that of the newest tick.
  std::function<void(const TrackedFrame&, const RobotFrame&)> on_frame;
  Time until{INT64_MAX};  // later releases are neither run nor compared
};

struct ReplayResult {
  std::string level;
  std::int64_t frames = 0;
  std::int64_t ticks = 0;
  std::int64_t records = 0;
  std::int64_t records_recorded = 0;
  std::int64_t overruns = 0;          // overrun decisions, taken from the recording
  std::int64_t mismatches = 0;        // records that differ from the recorded ones
  std::int64_t first_mismatch = -1;   // its number
  std::int64_t versions_missing = 0;  // ticks that read a version missing in the recording
  RecordingLosses losses;             // nonzero only if the tolerance allows losses
  std::int64_t records_compared = 0;  // none after a gap: the tracker lacks frames from there on
  std::string output_sha256;          // of the recomputed records
  std::string recorded_sha256;        // of the run, written at its end
  // A recording that ended early has no hash, and its last tick may be incomplete. Of a damaged
  // recording, the records before the damage are compared.
  [[nodiscard]] bool agrees() const {
    if (mismatches != 0) return false;
    if (recorded_sha256.empty() || losses.any()) return records_compared > 0;
    return versions_missing == 0 && records == records_recorded && output_sha256 == recorded_sha256;
  }
};

// Throws InputError for a file that is no recording, for an incomplete one, and for one without
// output records.
[[nodiscard]] ReplayResult replay(const std::string& file, const ReplayOptions& options);

}  // namespace glint
