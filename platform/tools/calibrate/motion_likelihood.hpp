// Log-likelihood of a recording under the hand motion model's noise and damping, with gradient:
// from the innovations of the filter (kernels/motion/motion_filter.hpp).
//
// Between measurements, mean, covariance and their sensitivities are integrated
// (motion_equations.hpp); the corrections are algebraic with analytic derivatives. Translation and
// rotation are measured and move independently, so that each has two unknowns of its own.
//
// Source: Schweppe 1965, "Evaluation of likelihood functions for Gaussian signals", IEEE
//         Transactions on Information Theory 11(1), eq. (15); the derivatives of a filter: Gupta
//         and Mehra 1974, IEEE Transactions on Automatic Control 19(6), section III.
#pragma once

#include <span>
#include <vector>

#include "kernels/motion/interpolate.hpp"
#include "kernels/motion/motion_filter.hpp"
#include "platform/tools/calibrate/motion_equations.hpp"

namespace glint {

// Standard deviation of a measurement, per axis.
struct MeasuredNoise {
  double position_sigma_m = 0.0005;
  double rotation_sigma_rad = 0.00524;  // 0.3 deg
};

struct Likelihood {
  double log_likelihood = 0;
  Vector2 gradient = Vector2::Zero();  // by ln noise, ln damping
  std::vector<Vector2> scores;         // of each innovation; their sum is the gradient
  int innovations = 0;                 // count; three components each
  bool integrated = true;
};

// Settings for one recording. The filter restarts after a gap longer than gap_max_s. `start`
// supplies the initial speed deviations of a (re)start.
struct LikelihoodSettings {
  MeasuredNoise noise;
  MotionSettings start;
  double gap_max_s = 0.5;
};

[[nodiscard]] Likelihood likelihood_of(std::span<const TimedPose> measured, MotionPart part,
                                       const MotionUnknowns& unknowns,
                                       const LikelihoodSettings& settings);

}  // namespace glint
