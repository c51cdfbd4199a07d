#include "kernels/pose/bias_correction.hpp"

#include <cmath>

#include "kernels/motion/interpolate.hpp"

namespace glint {

ViewGeometry view_geometry(const Pose& T_camera_tool) noexcept {
  ViewGeometry seen;
  seen.range_m = T_camera_tool.translation.norm();
  if (!(seen.range_m > 0)) return seen;
  const Vector3 sight = T_camera_tool.translation / seen.range_m;
  seen.off_axis_cosine = sight.z();
  seen.tilt_cosine = sight.dot(T_camera_tool.rotation * Vector3::UnitZ());
  return seen;
}

CorrectedPose correct_bias(const BiasCorrection& correction, const Pose& T_camera_tool) noexcept {
  if (correction.frame == CorrectionFrame::none) return {T_camera_tool, Reason::not_prepared};
  const ViewGeometry seen = view_geometry(T_camera_tool);
  const bool valid = correction.range_m.holds(seen.range_m) &&
                     correction.off_axis_cosine.holds(seen.off_axis_cosine) &&
                     correction.tilt_cosine.holds(seen.tilt_cosine);
  if (!valid) return {T_camera_tool, Reason::out_of_range};
  const Quaternion turn = from_rotation_vector(correction.rotation_rad);
  if (correction.frame == CorrectionFrame::tool)
    return {T_camera_tool * Pose{turn, correction.translation_m}, Reason::none};
  return {{(turn * T_camera_tool.rotation).normalized(),
           T_camera_tool.translation + correction.translation_m},
          Reason::none};
}

}  // namespace glint
