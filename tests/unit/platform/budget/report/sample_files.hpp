// Files as the parts of `glint budget` and `glint run` leave them, small and with known content.
#pragma once

#include <string>

#include "platform/budget/export/trace_file.hpp"

namespace glint {

struct SampleSettings {
  int frames = 4000;
  bool one_frame_above_bound = false;  // FindBlobs of one frame takes longer than its bound
  bool best_effort = true;
  bool check_fails = false;
  bool real_time = true;  // else the run computed its latencies
};

// A frame group on two cores and a tick group on the first. Times are drawn independently from
// fixed distributions, from a fixed seed; the frame with the largest response is number 1234.
[[nodiscard]] TraceFile sample_trace(const SampleSettings& settings);

// Writes measure.json, measure_time.json, check.json, footprint.json and run/{summary.json,
// trace.spans} into the folder.
void write_samples(const std::string& folder, const SampleSettings& settings);

}  // namespace glint
