// Where the tip of a tool is in each tracked frame, and how each stated error acts on it there.
#pragma once

#include <string>
#include <vector>

#include "kernels/motion/head_walk.hpp"
#include "kernels/pose/calibration_errors.hpp"
#include "platform/tools/recorded_frames.hpp"

namespace glint {

inline constexpr int k_marker_errors = 3 * k_markers_per_tool_max;
using TipByCalibration = Eigen::Matrix<double, 3, k_calibration_errors>;
using TipByMarkers = Eigen::Matrix<double, 3, k_marker_errors>;
using TipByHead = Eigen::Matrix<double, 3, 6>;

// In the world where the headset gives its pose, else in the camera's frame.
struct TipSighting {
  Time time;
  Quaternion rotation = Quaternion::Identity();  // of the tool
  Vector3 tip_m = Vector3::Zero(), middle_m = Vector3::Zero();
  Matrix3 random_m2 = Matrix3::Zero();
  // m a stated sigma, in the order of kernels/pose/calibration_errors.hpp.
  TipByCalibration by_calibration = TipByCalibration::Zero();
  // Of each marker its range (m a m), its centroid to the right and down (m a px).
  TipByMarkers by_markers = TipByMarkers::Zero();
  TipByHead by_head = TipByHead::Zero();  // the headset's error at its pivot; zero: no head pose
  Matrix3 moving_m2 = Matrix3::Zero();    // of that error, what the head's motion adds
  double range_m = 0;                     // the markers' mean
  bool refused = false;                   // by the tracker, as a bad fit
};

// What is stated of the errors.
struct StatedErrors {
  CameraUncertainty camera;
  CorrelationTimes correlation;
  HeadNoise head;
  double tip_sigma_m = 0;  // of the tip among the markers, an axis
};

struct TipSeries {
  std::string what;  // the source, for messages
  Tool tool;
  StatedErrors stated;
  bool in_world = true;
  std::vector<TipSighting> sightings;
  CalibrationErrors residuals;  // what those of single fits show
  int frames = 0;
  int refused = 0;  // sightings that the tracker refused: the markers do not fit the tool
  std::vector<std::string> failures;  // what could not be read, a line each
};

// By the tracker's fit of each frame, and by the fits that it refused as bad: a calibration error
// may be the cause. The frames of the less frequent frame of reference are left out. Throws
// InputError: the tool is in none of them.
[[nodiscard]] TipSeries sight_tips(RecordedFrames& recorded, std::size_t tool);

}  // namespace glint
