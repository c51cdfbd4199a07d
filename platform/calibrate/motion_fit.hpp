// The most likely noise and damping of one part of a hand's motion, and how sure they are. The
// damping is taken to be within a factor of e of the start, 1 sigma: a minute of motion outweighs
// that wherever it shows the damping at all.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "platform/calibrate/motion_likelihood.hpp"

namespace glint {

struct MotionFit {
  MotionUnknowns unknowns;
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  // of ln noise, ln damping
  bool determined = false;                               // the likelihood falls to all sides of it
  double log_likelihood = 0;
};

using MotionSeries = std::vector<std::vector<StampedPose>>;

// The likelihood of several series together. `evaluated` is called after each; may be empty.
[[nodiscard]] Likelihood likelihood_of(const MotionSeries& series, MotionPart part,
                                       const MotionUnknowns& unknowns,
                                       const LikelihoodSettings& settings);

[[nodiscard]] MotionFit most_likely(const MotionSeries& series, MotionPart part,
                                    const MotionUnknowns& start, const LikelihoodSettings& settings,
                                    const std::function<void()>& evaluated);

}  // namespace glint
