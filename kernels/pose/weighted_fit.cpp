#include "kernels/pose/weighted_fit.hpp"

#include <algorithm>
#include <cmath>

namespace glint {
namespace {

constexpr double k_decrease_least = 1e-4;  // of chi-square
// Levenberg's factor: after a step taken back, and its growth and fall from there.
constexpr double k_damping_first = 0.01;
constexpr double k_damping_growth = 10;
constexpr double k_damping_least = 1e-4;  // below it none: Gauss-Newton converges faster

bool evaluate(std::span<const WeightedMarker> markers, const Vector3& mean_m, const Pose& pose,
              const PosePrior* prior, NormalEquations& normal) {
  normal = {};
  if (!add_markers(markers, pose, mean_m, normal)) return false;
  if (prior != nullptr) add_prior(*prior, pose, mean_m, normal);
  return std::isfinite(normal.chi_square);
}

// The mean moved, and turned about it: by twice the angle whose tangent is half the rotation
// vector's length, which is as good a step and needs no sine.
Pose stepped(const Pose& pose, const Vector3& mean_m, const Vector6& step) {
  const Quaternion turn(1, 0.5 * step(3), 0.5 * step(4), 0.5 * step(5));
  const Vector3 mean = pose * mean_m + step.head<3>();
  Pose out;
  out.rotation = (turn * pose.rotation).normalized();
  out.translation = mean - out.rotation * mean_m;
  return out;
}

}  // namespace

WeightedFit fit_weighted(std::span<const WeightedMarker> markers, const Vector3& mean_m,
                         const Pose& start, const PosePrior* prior, int steps_max) noexcept {
  WeightedFit fit;
  fit.T_camera_tool = start;
  NormalEquations here;
  fit.steps = 1;
  if (!evaluate(markers, mean_m, start, prior, here)) {
    fit.reason = Reason::degenerate;
    return fit;
  }
  double damping = 0;
  for (;;) {
    Matrix6 damped = here.matrix;
    damped.diagonal() *= 1 + damping;
    const Result<PoseFactor> factor = pose_factor(damped);
    if (!factor) {
      fit.reason = Reason::degenerate;
      return fit;
    }
    const Vector6 step = -factor.value.solve(here.slope);
    const Pose there = stepped(fit.T_camera_tool, mean_m, step);
    const bool arrived = -step.dot(here.slope) < k_decrease_least;
    if (arrived) fit.T_camera_tool = there;
    if (arrived || fit.steps >= steps_max) break;
    NormalEquations next;
    ++fit.steps;
    if (evaluate(markers, mean_m, there, prior, next) && next.chi_square <= here.chi_square) {
      fit.T_camera_tool = there;
      here = next;
      damping = damping > k_damping_least ? damping / k_damping_growth : 0;
    } else {
      damping = std::max(k_damping_first, damping * k_damping_growth);
    }
  }
  fit.chi_square = here.chi_square;
  fit.information = here.matrix;
  return fit;
}

}  // namespace glint
