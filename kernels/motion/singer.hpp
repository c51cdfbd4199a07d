// Damped acceleration: how place, speed and acceleration of one axis go on, and what chance adds.
//
// What:     p' = v, v' = a, a' = -damping a + white noise. The transition over a time and the
//           covariance that noise of density 1 gathers in it.
// Cost:     five exponentials, 0.15 us.
// Worst:    any damping >= 0 and any time in [0, 10 s]; time zero moves nothing.
// Accuracy: transition 1e-13; covariance (the quadrature) 1e-9 for damping * time <= 0.1,
//           1e-5 at 1, 1e-2 at 5.
// Source:   Singer 1970, Estimating optimal tracking filter performance for manned maneuvering
//           targets: acceleration with exponential autocorrelation; q = 2 damping sigma_a^2. The
//           covariance, int_0^t g(s) g(s)' ds, by Gauss and Legendre's four points.
#pragma once

#include "kernels/geometry.hpp"
#include "kernels/nonblocking.hpp"

namespace glint {

struct SingerStep {
  double seconds = 0;                // place by speed
  double place_by_acceleration = 0;  // s^2
  double speed_by_acceleration = 0;  // s
  double acceleration_kept = 1;      // share
  Matrix3 noise = Matrix3::Zero();   // of (place, speed, acceleration), density 1
};

[[nodiscard]] SingerStep singer_step(double damping_1_s, double seconds) noexcept GLINT_NONBLOCKING;

}  // namespace glint
