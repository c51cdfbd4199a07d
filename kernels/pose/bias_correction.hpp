// Constant bias correction of a pose by the mean error of a static run, valid only where it was
// measured.
//
// What:     a constant translation and rotation along the tool's or the camera's axes. It applies
//           to poses within the run's limits of distance, angle off the camera's axis and tilt. Any
//           other pose stays unchanged, with a Reason.
// Cost:     one rotation's sine and cosine, one square root, two products of quaternions.
// Worst:    data independent; a pose that is not finite stays unchanged.
// Accuracy: that of the mean error; errors that vary with position or time remain.
// Source:   Puljiz et al., "Inside-out Infrared Marker Tracking via Head Mounted Displays for Smart
//           Robot Programming": the mean of a static run as a correction of later ones.
#pragma once

#include <cstdint>

#include "kernels/geometry.hpp"
#include "kernels/nonblocking.hpp"
#include "kernels/reason.hpp"

namespace glint {

// Frame along whose axes the error is constant. none: no correction.
enum class CorrectionFrame : std::uint8_t { none, tool, camera };

// Closed interval.
struct ValidRange {
  double from = 0, to = 0;
  [[nodiscard]] bool holds(double value) const { return value >= from && value <= to; }
};

struct BiasCorrection {
  CorrectionFrame frame = CorrectionFrame::none;
  Vector3 translation_m = Vector3::Zero();
  Vector3 rotation_rad = Vector3::Zero();  // rotation vector
  ValidRange range_m;                      // distance of the tool's origin from the camera
  ValidRange off_axis_cosine;              // between the optical axis and the ray to that origin
  ValidRange tilt_cosine;                  // between the tool's z axis and that ray
};

struct CorrectedPose {
  Pose T_camera_tool;
  Reason reason = Reason::none;  // none: corrected; not_prepared: there is no correction;
                                 // out_of_range: outside the measured limits. The last two leave
                                 // the pose unchanged.
};

[[nodiscard]] CorrectedPose correct_bias(const BiasCorrection& correction,
                                         const Pose& T_camera_tool) noexcept GLINT_NONBLOCKING;

// Quantities that decide whether a correction is valid for a pose. Cosines are 1 if the range is 0.
struct ViewGeometry {
  double range_m = 0;
  double off_axis_cosine = 1;
  double tilt_cosine = 1;
};
[[nodiscard]] ViewGeometry view_geometry(const Pose& T_camera_tool) noexcept GLINT_NONBLOCKING;

}  // namespace glint
