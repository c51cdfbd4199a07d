// Collects the measured frames of one tool, as the input of the stroke smoother
// (kernels/path/smooth_stroke).
//
// A frame counts as measured if the motion filter accepted a full, unambiguous pose of it. Frames
// with one or two markers are not used.
#pragma once

#include <functional>
#include <vector>

#include "kernels/path/smooth_stroke.hpp"
#include "nodes/predict_tools.hpp"
#include "platform/runtime/session/tracked_frame.hpp"

namespace glint {

struct MeasuredFrame {
  StrokeFrame frame;
  bool restarts = false;   // the tracker restarted its estimate: earlier frames are unrelated
  int frames_without = 0;  // usable frames since the previous measured one, without a pose
  ReferenceFrame base = ReferenceFrame::camera;
  // Covariances of errors that frames share, about the pose's point, along the base's axes.
  Matrix6 head_covariance = Matrix6::Zero();
  Matrix6 systematic = Matrix6::Zero();  // calibration and correlated errors
  double stamp_s2 = 0;                   // variance of the time stamp
  bool has_robot = false;
  Pose T_base_robot;
  TipPosition tip;
};

class MeasuredFrames {
 public:
  // stamp_sigma_s: standard deviation of mid-exposure, beside the frame's own. `wanted`: whether a
  // frame of this time is kept; empty: all are.
  MeasuredFrames(std::size_t tool, double stamp_sigma_s, std::function<bool(Time)> wanted = {});

  // Requires all frames in the order of processing.
  void add(const TrackedFrame& tracked, const RobotFrame& robot);

  // In rising order of time stamps, apart from restarts.
  [[nodiscard]] const std::vector<MeasuredFrame>& frames() const { return frames_; }

 private:
  std::size_t tool_;
  double stamp_sigma_s_;
  std::function<bool(Time)> wanted_;
  std::vector<MeasuredFrame> frames_;
  // Since the last measured frame.
  bool restarts_ = true;
  int frames_without_ = 0;
  Pose parent_moved_;
  Matrix6 parent_noise_ = Matrix6::Zero();
  // At the last measured frame.
  ReferenceFrame base_ = ReferenceFrame::camera;
  Vector3 place_ = Vector3::Zero();
  NoiseScale noise_;
  double inflation_scale_ = 1;
};

}  // namespace glint
