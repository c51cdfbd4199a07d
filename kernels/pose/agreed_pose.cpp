#include "kernels/pose/agreed_pose.hpp"

#include <cmath>

#include "kernels/motion/interpolate.hpp"
#include "kernels/pose/lever_arm.hpp"

namespace glint {

AgreedPose agreed_pose(std::span<const WeightedMarker> markers, const ExpectedPose& expected,
                       int steps_max) noexcept {
  AgreedPose agreed;
  const Vector3 mean_m = mean_of(markers);
  const Result<PoseFactor> known = pose_factor(expected.covariance);
  if (!known) {
    agreed.reason = Reason::degenerate;
    return agreed;
  }
  const PosePrior prior{expected.T_camera_tool, known.value.inverse(), expected.reference_m};
  const WeightedFit fit = fit_weighted(markers, mean_m, expected.T_camera_tool, &prior, steps_max);
  agreed.steps = fit.steps;
  agreed.reason = fit.reason;
  if (agreed.reason != Reason::none) return agreed;
  const Pose& x = fit.T_camera_tool;
  NormalEquations alone;
  const Result<PoseFactor> factor = add_markers(markers, x, mean_m, alone)
                                        ? pose_factor(alone.matrix)
                                        : Result<PoseFactor>{{}, Reason::degenerate};
  if (!factor) {
    agreed.reason = Reason::degenerate;
    return agreed;
  }
  const Vector6 step = -factor.value.solve(alone.slope);
  const Vector3 turn = step.tail<3>();
  const Vector3 lever = x.rotation * (expected.reference_m - mean_m);
  const Vector3 reference = x * expected.reference_m + step.head<3>() + turn.cross(lever);
  Pose& out = agreed.T_camera_tool;
  out.rotation = (from_rotation_vector(turn) * x.rotation).normalized();
  out.translation = reference - out.rotation * expected.reference_m;
  agreed.covariance = moved_covariance(factor.value.inverse(), lever);
  if (!std::isfinite(agreed.covariance.sum())) agreed.reason = Reason::degenerate;
  return agreed;
}

}  // namespace glint
