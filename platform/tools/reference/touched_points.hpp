// Touches of known points of a robot: their coordinates from a file, the tip's positions from the
// same file or from a recording in which the pen's button was held at each point.
#pragma once

#include <string>
#include <vector>

#include "platform/sinks/record/button_event.hpp"
#include "platform/sinks/record/recording_reader.hpp"
#include "platform/tools/reference/touched_base.hpp"

namespace glint {

struct TouchOptions {
  double sigma_m = 0.001;            // own error of a touch, an axis: tip, known point and hand
  std::string tool;                  // name of the pen; empty: the first in the recording
  std::vector<ButtonEvent> presses;  // replace the recording's events; empty: use those
  ReadTolerance tolerance;
};

// [[point]] with name, position_mm (in the base's frame) and, without a recording, tip_mm.
// Throws InputError with file and line.
[[nodiscard]] std::vector<TouchedPoint> read_touches(const std::string& file,
                                                     const TouchOptions& options);

struct RecordedTouches {
  bool in_reference = false;  // the tips are in the reference tool's frame; else in the world
  RecordingLosses losses;     // only if the tolerance allows losses
};

// Sets the tips of the points, in the order of the touches. A touch lasts from press to release of
// draw; its tip is the mean over the measured poses meanwhile. delete_last and undo remove the last
// touch; finish ends the input. A pose that is already in a robot's frame is transformed back by
// the recorded cell's [robot], whose own uncertainty is removed.
// Throws InputError naming recording and touch: another number of touches than points, no measured
// pose, a tip that moved, poses in the camera's frame.
[[nodiscard]] RecordedTouches set_tips(std::vector<TouchedPoint>& points,
                                       const std::string& recording, const TouchOptions& options);

}  // namespace glint
