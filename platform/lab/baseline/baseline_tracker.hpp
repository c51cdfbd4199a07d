// Tracker of the baseline for one tool: a pose per frame, and a pose at any time between and after
// frames.
//
// Source:   Puljiz et al., Inside-out Infrared Marker Tracking via Head Mounted Displays for Smart
//           Robot Programming, section III. Where it leaves a choice open: a blob's depth is the
//           median over its inner disc, else over all of it, else over the blob and its rim.
//           HoloLens depth is radial; Z follows from the blob's ray.
#pragma once

#include <span>
#include <vector>

#include "kernels/image/frame.hpp"
#include "kernels/motion/interpolate.hpp"
#include "kernels/pose/head_pose.hpp"
#include "kernels/pose/tool.hpp"
#include "kernels/result.hpp"
#include "platform/lab/baseline/baseline_match.hpp"
#include "platform/lab/baseline/front_end.hpp"

namespace glint {

struct BaselineResult {
  Reason reason = Reason::no_frame_yet;
  Pose T_camera_tool;  // valid if reason is none
  int marker_count = 0;
  double rms_m = 0;
  bool from_roi = false;  // found in the predicted ROI
};

class BaselineTracker {
 public:
  // Requires a prepared tool.
  BaselineTracker(const Camera& camera, const Tool& tool, const BaselineSettings& settings = {});

  // Call in order of the time stamps. Rejects a frame that is not later than the newest pose.
  BaselineResult process(const Frame& frame, const HeadPose& head);

  // Returns T_base_tool by constant velocity and SLERP. The base is the world if the newest pose
  // had a valid head pose, else the camera. Returns Reason::too_old beyond
  // BaselineSettings::lost_after.
  [[nodiscard]] Result<Pose> pose_at(Time time) const;

  // Undistorts, thresholds, halves and detects on the whole frame; for the benchmark's timing.
  std::span<const BaselineBlob> front_end(const Frame& frame);

 private:
  void search(const Frame& frame, const cv::Rect& roi);
  BaselineMatch match(const Frame& frame);
  [[nodiscard]] cv::Rect predicted_roi(const Frame& frame, const HeadPose& head) const;
  [[nodiscard]] double blob_depth(const Frame& frame, const BaselineBlob& blob);
  [[nodiscard]] double median_depth(const Frame& frame, const Vector2& raw_px, double radius_px);

  Camera camera_;
  Tool tool_;
  BaselineSettings settings_;
  BaselineFrontEnd front_end_;
  std::vector<Vector3> points_m_;
  std::vector<std::uint16_t> depths_;
  TimedPose previous_, newest_;  // T_base_tool
  int poses_ = 0;                // number of valid poses of the two: 0, 1 or 2
  bool in_world_ = false;
};

}  // namespace glint
