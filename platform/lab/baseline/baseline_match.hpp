// Marker labeling and pose fit of the baseline: every set of points whose distance matrix equals
// the tool's within delta is fitted by SVD. The set with most markers wins, then the least rms.
//
// Source:   Puljiz et al., section III: |d_R - d_M| < delta, SVD with the determinant's sign.
#pragma once

#include <array>
#include <span>

#include "kernels/geometry.hpp"
#include "kernels/pose/tool.hpp"
#include "platform/lab/baseline/baseline_settings.hpp"

namespace glint {

struct BaselineMatch {
  Reason reason = Reason::no_labeling;
  std::array<int, k_markers_per_tool_max> point{};  // index into the points, -1 where unseen
  int count = 0;
  int hypotheses = 0;  // partial assignments tried
  double rms_m = 0;
  Pose T_camera_tool;
};

inline constexpr int k_baseline_points_max = 64;  // later points are ignored

// points_m: marker centres in the camera frame.
[[nodiscard]] BaselineMatch match_tool(std::span<const Vector3> points_m, const Tool& tool,
                                       const BaselineSettings& settings);

}  // namespace glint
