// Drift of the headset's localisation, from a static tool in view of a moving head: one factor on
// all values of a cell's [headset], with its uncertainty (kernels/motion/world_errors.hpp). The
// factor is one sigma above the best fit, so that a short recording overestimates the drift.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "kernels/motion/head_drift.hpp"
#include "platform/tools/inspect/recorded_frames.hpp"

namespace glint {

struct HeadsetCalibration {
  HeadNoise noise;          // the declared noise times `factor`
  double factor = 1;        // best_factor * (1 + sigma)
  double best_factor = 1;   // best fit, in units of the declared deviations
  double sigma = 0;         // relative standard deviation of `best_factor`
  double head_delay_s = 0;  // delay of the head poses behind the frames; not corrected
  double head_late_sigma_s = 0;
  int frames = 0;
  std::vector<std::string> failures;  // read errors of the frames, a line each
};

// tool: index of the cell's static tool. Throws InputError, naming the frames, if too few of them
// show the tool together with a head pose.
[[nodiscard]] HeadsetCalibration calibrate_headset(RecordedFrames& recorded, std::size_t tool);

}  // namespace glint
