#include "kernels/pose/map_pose.hpp"

#include <cmath>

#include "kernels/motion/interpolate.hpp"
#include "kernels/pose/depth_flip.hpp"
#include "kernels/pose/lever_arm.hpp"

namespace glint {
namespace {

// Moves the reference point along a straight line, whatever the step's rotation: the covariance of
// position and rotation is linear, as the filter's equations are.
Pose stepped(const Pose& x, const Vector6& step, const Vector3& lever, const Vector3& reference_m) {
  const Vector3 turn = step.tail<3>();
  const Vector3 reference = x * reference_m + step.head<3>() + turn.cross(lever);
  Pose out;
  out.rotation = (from_rotation_vector(turn) * x.rotation).normalized();
  out.translation = reference - out.rotation * reference_m;
  return out;
}

// Gauss-Newton step from x, and the covariance at x.
LinearisedPose gauss_newton_step(const NormalEquations& normal, const Pose& x,
                                 const Vector3& mean_m, const Vector3& reference_m) {
  LinearisedPose near;
  const Result<PoseFactor> factor = pose_factor(normal.matrix);
  if (!factor) {
    near.reason = Reason::degenerate;
    return near;
  }
  const Vector3 lever = x.rotation * (reference_m - mean_m);
  const Vector6 step = -factor.value.solve(normal.gradient);
  near.T_camera_tool = stepped(x, step, lever, reference_m);
  near.covariance = moved_covariance(factor.value.inverse(), lever);
  near.chi_square = normal.chi_square;
  if (!std::isfinite(near.covariance.sum())) near.reason = Reason::degenerate;
  return near;
}

}  // namespace

Pose face_on_pose(std::span<const WeightedMarker> markers, const Pose& T_camera_tool) noexcept {
  const Vector3 mean_m = mean_of(markers);
  const Pose flip = depth_flipped(T_camera_tool, flattest_direction(markers, mean_m), mean_m);
  Pose out;
  out.rotation = slerp(T_camera_tool.rotation, flip.rotation, 0.5);
  out.translation = T_camera_tool * mean_m - out.rotation * mean_m;
  return out;
}

LinearisedPose linearised_pose(std::span<const WeightedMarker> markers, const Pose& x,
                               const Vector3& reference_m) noexcept {
  const Vector3 mean_m = mean_of(markers);
  NormalEquations alone;
  if (add_markers(markers, x, mean_m, alone))
    return gauss_newton_step(alone, x, mean_m, reference_m);
  LinearisedPose none;
  none.reason = Reason::degenerate;
  return none;
}

MapPose map_pose(std::span<const WeightedMarker> markers, const PredictedPose& expected,
                 int steps_max) noexcept {
  MapPose agreed;
  agreed.reason = Reason::degenerate;
  const Vector3 mean_m = mean_of(markers);
  const Result<PoseFactor> prediction_factor = pose_factor(expected.covariance);
  if (!prediction_factor) return agreed;
  const PosePrior prior{expected.T_camera_tool, prediction_factor.value.inverse(),
                        expected.reference_m};
  const WeightedFit fit = fit_weighted(markers, mean_m, expected.T_camera_tool, &prior, steps_max);
  agreed.steps = fit.steps;
  agreed.reason = fit.reason;
  if (agreed.reason != Reason::none) return agreed;
  static_cast<LinearisedPose&>(agreed) =
      linearised_pose(markers, fit.T_camera_tool, expected.reference_m);
  agreed.chi_square = fit.chi_square;
  return agreed;
}

}  // namespace glint
