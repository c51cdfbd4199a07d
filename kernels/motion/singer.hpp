// Singer motion model of one axis (damped acceleration): state transition and process noise.
//
// What:     p' = v, v' = a, a' = -damping a + white noise. The transition over a time step and the
//           process noise covariance for white noise of density 1.
// Cost:     five exponentials, 0.15 us.
// Worst:    any damping >= 0 and any time in [0, 10 s]; time zero is the identity.
// Accuracy: transition 1e-13; covariance (the quadrature) 1e-9 for damping * time <= 0.1,
//           1e-5 at 1, 1e-2 at 5.
// Source:   Singer 1970, Estimating optimal tracking filter performance for manned maneuvering
//           targets: acceleration with exponential autocorrelation; q = 2 damping sigma_a^2. The
//           covariance, int_0^t g(s) g(s)' ds, by four-point Gauss-Legendre quadrature.
#pragma once

#include "kernels/geometry.hpp"
#include "kernels/nonblocking.hpp"

namespace glint {

struct SingerStep {
  double seconds = 0;                   // d position / d velocity
  double position_by_acceleration = 0;  // d position / d acceleration, s^2
  double velocity_by_acceleration = 0;  // d velocity / d acceleration, s
  double acceleration_decay = 1;        // fraction
  Matrix3 noise = Matrix3::Zero();      // of (position, velocity, acceleration), density 1
};

[[nodiscard]] SingerStep singer_step(double damping_1_s, double seconds) noexcept GLINT_NONBLOCKING;

}  // namespace glint
