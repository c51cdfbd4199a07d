// Poses to calibrate with: from a trajectory file, a recording, or bare marker positions and the
// tool.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kernels/motion/interpolate.hpp"
#include "kernels/pose/tool.hpp"

namespace glint {

struct PoseSource {
  // TUM text or EuRoC-like CSV, of the tool's frame; or a recording (.mcap) of level blobs or more:
  // the tool in the camera's frame, each frame by itself; the tool is one of its own, by name.
  std::string poses;
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
