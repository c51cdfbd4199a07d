// How far the headset's own localisation wanders, by a tool that rests in view while the head
// moves: one factor of all that a cell's [headset] declares, with its uncertainty
// (kernels/motion/world_errors.hpp). The factor is one sigma above what fits best, so that a short
// recording states more, not less.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "kernels/motion/head_walk.hpp"
#include "platform/tools/recorded_frames.hpp"

namespace glint {

struct HeadsetCalibration {
  HeadNoise noise;         // as declared, by `factor`
  double factor = 1;       // best * (1 + sigma)
  double best = 1;         // of the declared deviations
  double sigma = 0;        // of it, as a ratio
  double head_late_s = 0;  // the head's poses are of so much earlier than the frames; not corrected
  double head_late_sigma_s = 0;
  int frames = 0;
  std::vector<std::string> failures;  // what of the frames could not be read, a line each
};

// tool: the number of the cell's tool that rests. Throws InputError, naming the frames, where too
// few of them show tool and head together.
[[nodiscard]] HeadsetCalibration calibrate_headset(RecordedFrames& recorded, std::size_t tool);

}  // namespace glint
