// Poses to calibrate with: from a trajectory file, or from bare marker positions and the tool.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kernels/motion/interpolate.hpp"
#include "kernels/pose/tool.hpp"

namespace glint {

struct PoseSource {
  std::string poses;    // TUM text or EuRoC-like CSV, of the tool's frame
  std::string points;   // unlabelled marker positions (CSV); needs the tool
  std::string tool;     // a tool file
  bool of_tip = false;  // the poses' origin is the tool's tip, as in a run's tip.tum
};

struct PoseSeries {
  std::vector<StampedPose> poses;  // stamps rise, from 0
  Time begin;                      // the first one's, as it stands in the file
  int unsolved = 0;                // point frames without a pose
  std::optional<Tool> tool;
  std::string what;  // the file, for messages
};

// Throws InputError for bad files, neither or both of poses and points, points without a tool, and
// of_tip without a tool.
[[nodiscard]] PoseSeries load_pose_series(const PoseSource& source);

}  // namespace glint
