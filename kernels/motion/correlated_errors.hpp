// Covariance of a window's mean under correlated measurement errors (Gauss-Markov processes).
//
// What:     the sum of two first-order Gauss-Markov processes, a fast and a slow one, each with a
//           covariance and a correlation time. covariance_of_mean: covariance of their mean over a
//           window; halves_covariance: of the difference between the means of the window's two
//           halves.
// Cost:     two exponentials and two sums of matrices.
// Worst:    data independent.
// Accuracy: exact for a continuous mean; frames further apart than fast_s average out less.
// Source:   autocovariance e^(-|t|/T), integrated twice: Brown and Hwang 2012, Introduction to
//           Random Signals and Applied Kalman Filtering, section 3.6.
#pragma once

#include "kernels/geometry.hpp"
#include "kernels/nonblocking.hpp"

namespace glint {

// Covariances of a pose, order (x, y, z, rx, ry, rz), metres and radians.
struct CorrelatedErrors {
  Matrix6 fast = Matrix6::Zero(), slow = Matrix6::Zero();
  [[nodiscard]] Matrix6 sum() const { return fast + slow; }
};

// Default: two static tools in front of a HoloLens 2, 120 s, `glint calibrate noise`.
struct CorrelationTimes {
  double fast_s = 0.5, slow_s = 20;
};

[[nodiscard]] Matrix6 covariance_of_mean(const CorrelatedErrors& errors,
                                         const CorrelationTimes& times,
                                         double window_s) noexcept GLINT_NONBLOCKING;
[[nodiscard]] Matrix6 halves_covariance(const CorrelatedErrors& errors,
                                        const CorrelationTimes& times,
                                        double window_s) noexcept GLINT_NONBLOCKING;

}  // namespace glint
