// Tracks a tool in bare marker positions, unlabelled: what any motion-capture system exports.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "nodes/tokens.hpp"

namespace glint {

struct PointPose {
  Time time;
  bool solved = false;
  Reason reason = Reason::none;
  std::uint8_t marker_mask = 0;
  double rms_m = 0;
  Pose pose;  // T_file_tool, in the frame of the file's coordinates
  Vector3 tip_m = Vector3::Zero();
};

struct PointsResult {
  std::vector<PointPose> frames;
  std::int64_t solved = 0;
  double rms_mean_m = 0;
  double rms_max_m = 0;
};

// Each frame is solved by itself, without a prior, so that one wrong frame misleads no other.
// Throws InputError for a bad file.
[[nodiscard]] PointsResult replay_points(const std::string& points_file,
                                         const std::string& tool_file);

}  // namespace glint
