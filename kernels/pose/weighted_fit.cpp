#include "kernels/pose/weighted_fit.hpp"

#include <algorithm>
#include <cmath>

namespace glint {
namespace {

constexpr double k_decrease_min = 1e-4;  // minimum decrease of chi-square
// A step of a tenth of a sigma: the information before such a step is valid after it.
constexpr double k_decrease_short = 1e-2;
// Damping factor: its initial value after an undone step, and its growth and decay.
constexpr double k_damping_first = 0.01;
constexpr double k_damping_growth = 10;
constexpr double k_damping_min = 1e-4;  // below it 0: Gauss-Newton converges faster

bool evaluate(std::span<const WeightedMarker> markers, const Vector3& mean_m, const Pose& pose,
              const PosePrior* prior, NormalEquations& normal) {
  normal = {};
  if (!add_markers(markers, pose, mean_m, normal)) return false;
  if (prior != nullptr) add_prior(*prior, pose, mean_m, normal);
  return std::isfinite(normal.chi_square);
}

// Translates the mean and rotates about it, by twice the angle whose tangent is half the rotation
// vector's length. This is as good a step and needs no sine.
Pose stepped(const Pose& pose, const Vector3& mean_m, const Vector6& step) {
  const Quaternion turn(1, 0.5 * step(3), 0.5 * step(4), 0.5 * step(5));
  const Vector3 mean = pose * mean_m + step.head<3>();
  Pose out;
  out.rotation = (turn * pose.rotation).normalized();
  out.translation = mean - out.rotation * mean_m;
  return out;
}

// Upper bound on the next step's decrease of chi-square, if the last two steps were undamped.
double next_decrease(double decrease, double decrease_before) {
  return decrease < k_decrease_short && decrease < decrease_before
             ? decrease * decrease / decrease_before
             : decrease;
}

}  // namespace

WeightedFit fit_weighted(std::span<const WeightedMarker> markers, const Vector3& mean_m,
                         const Pose& start, const PosePrior* prior, int steps_max,
                         double chi_square_stop) noexcept {
  WeightedFit fit;
  fit.T_camera_tool = start;
  NormalEquations here;
  fit.steps = 1;
  if (!evaluate(markers, mean_m, start, prior, here)) {
    fit.reason = Reason::degenerate;
    return fit;
  }
  double damping = 0, decrease_before = 0;
  for (;;) {
    Matrix6 damped = here.matrix;
    damped.diagonal() *= 1 + damping;
    const Result<PoseFactor> factor = pose_factor(damped);
    if (!factor) {
      fit.reason = Reason::degenerate;
      return fit;
    }
    const Vector6 step = -factor.value.solve(here.gradient);
    const Pose there = stepped(fit.T_camera_tool, mean_m, step);
    const double decrease = -step.dot(here.gradient);
    if (next_decrease(decrease, decrease_before) < k_decrease_min) {
      fit.T_camera_tool = there;
      here.chi_square = std::max(0.0, here.chi_square - decrease);
      break;
    }
    if (fit.steps >= steps_max) break;
    if (fit.steps == k_steps_before_limit && here.chi_square > chi_square_stop) {
      fit.reason = Reason::bad_fit;
      return fit;
    }
    NormalEquations next;
    ++fit.steps;
    if (evaluate(markers, mean_m, there, prior, next) && next.chi_square <= here.chi_square) {
      fit.T_camera_tool = there;
      here = next;
      decrease_before = damping > 0 ? 0 : decrease;
      damping = damping > k_damping_min ? damping / k_damping_growth : 0;
    } else {
      damping = std::max(k_damping_first, damping * k_damping_growth);
    }
  }
  fit.chi_square = here.chi_square;
  fit.information = here.matrix;
  return fit;
}

}  // namespace glint
