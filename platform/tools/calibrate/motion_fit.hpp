// MAP estimate of noise and damping of one part of the hand motion, with covariance. The prior of
// the damping is a factor of e around the initial guess, 1 sigma. A minute of motion outweighs it
// wherever the motion shows the damping.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "platform/tools/calibrate/motion_likelihood.hpp"

namespace glint {

struct MotionFit {
  MotionUnknowns unknowns;
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  // of ln noise, ln damping
  bool determined = false;  // the likelihood has a strict maximum there
  double log_likelihood = 0;
};

using MotionSeries = std::vector<std::vector<TimedPose>>;

// Sums the likelihood over several series.
[[nodiscard]] Likelihood likelihood_of(const MotionSeries& series, MotionPart part,
                                       const MotionUnknowns& unknowns,
                                       const LikelihoodSettings& settings);

// Maximises the likelihood. Calls `evaluated`, which may be empty, after each evaluation.
[[nodiscard]] MotionFit maximise_likelihood(const MotionSeries& series, MotionPart part,
                                            const MotionUnknowns& start,
                                            const LikelihoodSettings& settings,
                                            const std::function<void()>& evaluated);

}  // namespace glint
