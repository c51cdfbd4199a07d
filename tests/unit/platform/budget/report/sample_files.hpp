// Small sample files with known content, as `glint budget` and `glint run` write them.
#pragma once

#include <string>

#include "platform/budget/export/trace_file.hpp"

namespace glint {

struct SampleSettings {
  int frames = 4000;
  bool one_frame_above_bound = false;  // one frame's FindBlobs exceeds its bound
  bool best_effort = true;
  bool check_fails = false;
  bool real_time = true;  // false: the run computed its latencies
};

// Trace of a frame group on two cores and a tick group on the first. Times are independent draws
// from fixed distributions with a fixed random seed. Frame 1234 has the largest response.
[[nodiscard]] TraceFile sample_trace(const SampleSettings& settings);

// Writes measure.json, measure_time.json, check.json, footprint.json and run/{summary.json,
// trace.spans} into the folder.
void write_samples(const std::string& folder, const SampleSettings& settings);

}  // namespace glint
