// Baseline predictors of a pose, each tuned once for all recordings by the same search as Glint's
// filter: the least sum, over recordings and horizons, of the error relative to linear + SLERP.
//
//   last value        the newest pose, held
//   linear + SLERP    through the last two poses (the published method)
//   one euro          Casiez, Roussel and Vogel 2012, algorithm 1; extrapolates its filtered speed
//   double exp.       LaViola 2003, Double exponential smoothing: an alternative to Kalman
//                     filter-based predictive tracking; orientations as quaternions
//   constant velocity Kalman filter with white acceleration: Bar-Shalom, Li and Kirubarajan 2001,
//                     section 6.2
#pragma once

#include <vector>

#include "platform/lab/experiments/predictor.hpp"

namespace glint {

struct OneEuroSettings {
  double cutoff_min_hz, cutoff_per_speed, speed_cutoff_hz;
};
struct PredictorSettings {
  OneEuroSettings euro_position{0.0124, 638, 24.6};   // cutoff per m/s
  OneEuroSettings euro_rotation{0.0204, 35.2, 3.44};  // cutoff per rad/s
  double exponential_position = 0.85, exponential_rotation = 0.516;
  double velocity_noise_m2_s3 = 0.09, angular_noise_rad2_s3 = 0.55;
};

[[nodiscard]] PredictorPointer make_last_value();
[[nodiscard]] PredictorPointer make_linear_slerp();
[[nodiscard]] PredictorPointer make_one_euro(const PredictorSettings& settings = {});
[[nodiscard]] PredictorPointer make_double_exponential(const PredictorSettings& settings = {});
[[nodiscard]] PredictorPointer make_constant_velocity(const PredictorSettings& settings = {});

}  // namespace glint
