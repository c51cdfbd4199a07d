// Tracking of a tool in unlabelled marker positions, as exported by a motion capture system.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kernels/geometry.hpp"
#include "kernels/reason.hpp"
#include "kernels/units.hpp"

namespace glint {

struct PointPose {
  Time time;
  bool solved = false;
  Reason reason = Reason::none;  // ambiguous: another pose is nearly as likely
  std::uint8_t marker_mask = 0;
  double rms_m = 0;
  // Margin to the next likely pose, in units of chi-square; infinite if there is none.
  double margin = 0;
  Pose pose;  // T_file_tool, in the frame of the file's coordinates
  Vector3 tip_m = Vector3::Zero();
};

struct PointsResult {
  std::vector<PointPose> frames;
  std::int64_t solved = 0;
  std::int64_t ambiguous = 0;
  double rms_mean_m = 0;
  double rms_max_m = 0;
  double margin_min = 0;  // of the solved frames
};

// Decides frames in close succession together (label_path.hpp). Throws InputError for a bad file.
[[nodiscard]] PointsResult replay_points(const std::string& points_file,
                                         const std::string& tool_file);

}  // namespace glint
