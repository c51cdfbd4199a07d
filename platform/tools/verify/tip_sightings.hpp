// Tip position of a tool in each tracked frame, with its derivatives by every stated error.
#pragma once

#include <string>
#include <vector>

#include "kernels/motion/head_drift.hpp"
#include "kernels/pose/calibration_errors.hpp"
#include "platform/tools/inspect/recorded_frames.hpp"

namespace glint {

inline constexpr int k_marker_errors = 3 * k_markers_per_tool_max;
using TipByCalibration = Eigen::Matrix<double, 3, k_calibration_errors>;
using TipByMarkers = Eigen::Matrix<double, 3, k_marker_errors>;
using TipByHead = Eigen::Matrix<double, 3, 6>;

// In the world frame if the headset supplies a pose, else in the camera frame.
struct TipObservation {
  Time time;
  Quaternion rotation = Quaternion::Identity();  // of the tool
  Vector3 tip_m = Vector3::Zero(), centroid_m = Vector3::Zero();
  Matrix3 random_m2 = Matrix3::Zero();
  // m per stated sigma, in the order of kernels/pose/calibration_errors.hpp.
  TipByCalibration by_calibration = TipByCalibration::Zero();
  // Per marker: range (m per m), centroid to the right and down (m per px).
  TipByMarkers by_markers = TipByMarkers::Zero();
  TipByHead by_head = TipByHead::Zero();  // by the headset's error at its pivot; zero: no head pose
  Matrix3 motion_covariance_m2 =
      Matrix3::Zero();    // increase of that error's covariance by head motion
  double range_m = 0;     // mean of the markers
  bool rejected = false;  // the tracker rejected the fit as bad_fit
};

// Stated error model.
struct StatedErrors {
  CameraUncertainty camera;
  CorrelationTimes correlation;
  HeadNoise head;
  double tip_sigma_m = 0;  // of the tip relative to the markers, per axis
};

struct TipSeries {
  std::string what;  // source name, for messages
  Tool tool;
  StatedErrors stated;
  bool in_world = true;
  std::vector<TipObservation> observations;
  CalibrationErrors residuals;  // from the residuals of single fits
  int frames = 0;
  int rejected = 0;  // observations rejected by the tracker: markers do not fit the tool
  std::vector<std::string> failures;  // read errors, a line each
};

// Uses the tracker's fit of each frame, and also fits rejected as bad_fit: a calibration error may
// be the cause. Drops the frames of the less frequent reference frame. Throws InputError if the
// tool is in no frame.
[[nodiscard]] TipSeries observe_tips(RecordedFrames& recorded, std::size_t tool);

}  // namespace glint
