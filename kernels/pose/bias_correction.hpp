// Taking off the mean error that a static run had against a reference, where it was measured.
//
// What:     a constant shift and turn, along the tool's axes or the camera's, for poses as far from
//           the camera, as far off its axis and as tilted as those of the run; any other is left
//           as it is, and that is said.
// Cost:     one rotation's sine and cosine, one square root, two products of quaternions.
// Worst:    none is worse than another; a pose that is not finite is left alone.
// Accuracy: that of the mean error; what errs by place or time stays.
// Source:   Puljiz et al., "Inside-out Infrared Marker Tracking via Head Mounted Displays for Smart
//           Robot Programming": the mean of a static run as a correction of later ones.
#pragma once

#include <cstdint>

#include "kernels/geometry.hpp"
#include "kernels/nonblocking.hpp"
#include "kernels/reason.hpp"

namespace glint {

// Along whose axes the error is constant. none: nothing is corrected.
enum class CorrectionFrame : std::uint8_t { none, tool, camera };

// Both ends included.
struct ValidRange {
  double from = 0, to = 0;
  [[nodiscard]] bool holds(double value) const { return value >= from && value <= to; }
};

struct BiasCorrection {
  CorrectionFrame frame = CorrectionFrame::none;
  Vector3 shift_m = Vector3::Zero();
  Vector3 turn_rad = Vector3::Zero();  // a rotation vector
  ValidRange range_m;                  // of the tool's origin from the camera
  ValidRange off_axis_cosine;          // between the camera's axis and the sight of that origin
  ValidRange tilt_cosine;              // between the tool's z and that sight
};

struct CorrectedPose {
  Pose T_camera_tool;
  Reason reason = Reason::none;  // none: corrected; not_prepared: there is no correction;
                                 // out_of_range: outside of what was measured. Then as it was.
};

[[nodiscard]] CorrectedPose correct_bias(const BiasCorrection& correction,
                                         const Pose& T_camera_tool) noexcept GLINT_NONBLOCKING;

// What decides whether a correction holds for a pose. Cosines are 1 where the range is 0.
struct SeenFrom {
  double range_m = 0;
  double off_axis_cosine = 1;
  double tilt_cosine = 1;
};
[[nodiscard]] SeenFrom seen_from(const Pose& T_camera_tool) noexcept GLINT_NONBLOCKING;

}  // namespace glint
