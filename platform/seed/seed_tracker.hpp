// The whole published method for one tool: frame in, pose out, and a pose at any time between and
// after frames.
//
// Source: Puljiz et al., Inside-out Infrared Marker Tracking via Head Mounted Displays for Smart
//         Robot Programming, section III. Where it leaves a choice open: a blob's depth is the
//         median over its middle, else over all of it, else over the rim; HoloLens gives radial
//         depth, of which Z is taken by the blob's own ray.
#pragma once

#include <span>
#include <vector>

#include "kernels/image/frame.hpp"
#include "kernels/motion/interpolate.hpp"
#include "kernels/pose/head_pose.hpp"
#include "kernels/pose/tool.hpp"
#include "kernels/result.hpp"
#include "platform/seed/front_end.hpp"
#include "platform/seed/seed_match.hpp"

namespace glint {

struct SeedResult {
  Reason reason = Reason::no_frame_yet;
  Pose T_camera_tool;  // where reason is none
  int marker_count = 0;
  double rms_m = 0;
  bool from_roi = false;  // found around the prediction
};

class SeedTracker {
 public:
  // The tool must be prepared.
  SeedTracker(const Camera& camera, const Tool& tool, const SeedSettings& settings = {});

  // Frames in the order of their stamps; a frame that is no later than the last one is refused.
  SeedResult process(const Frame& frame, const HeadPose& head);

  // T_base_tool by constant velocity and SLERP; the base is the world where the last frame had a
  // valid head pose, else the camera. Reason::too_old beyond SeedSettings::lost_after.
  [[nodiscard]] Result<Pose> pose_at(Time time) const;

  // Undistort, threshold, halve, detect on the whole frame: what the benchmark times.
  std::span<const SeedBlob> front_end(const Frame& frame);

 private:
  void search(const Frame& frame, const cv::Rect& roi);
  SeedMatch match(const Frame& frame);
  [[nodiscard]] cv::Rect predicted_roi(const Frame& frame, const HeadPose& head) const;
  [[nodiscard]] double blob_depth(const Frame& frame, const SeedBlob& blob);
  [[nodiscard]] double median_depth(const Frame& frame, const Vector2& raw_px, double radius_px);

  Camera camera_;
  Tool tool_;
  SeedSettings settings_;
  SeedFrontEnd front_end_;
  std::vector<Vector3> points_m_;
  std::vector<std::uint16_t> depths_;
  StampedPose previous_, newest_;  // T_base_tool
  int poses_ = 0;                  // 0, 1 or 2 of them hold
  bool in_world_ = false;
};

}  // namespace glint
