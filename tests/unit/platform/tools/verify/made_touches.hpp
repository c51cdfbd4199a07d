// Synthetic observations of a tool that touches two points and then is static, with given errors
// and no camera.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>

#include "platform/sim/random.hpp"
#include "platform/tools/verify/tip_sightings.hpp"

namespace glint::test {

inline constexpr double k_made_distance_m = 0.2;
inline constexpr double k_made_noise_m = 0.0005;  // each axis, one observation

struct SyntheticTouches {
  int touches = 15;  // every third touch is of the second point
  double touch_s = 2, rest_s = 21;
  double lean_rad = 0.4, distance_m = k_made_distance_m;
  Vector3 errors = Vector3::Zero();  // range offset and principal point, in standard deviations
  // Added to the tip at a time of a touch, or of the static window (touch = -1).
  std::function<Vector3(int touch, double seconds)> drift = {};
};

// The camera's direction differs for each touch. Its errors move the tip along its axes, 5 mm a
// standard deviation.
inline TipSeries series_of(const SyntheticTouches& made) {
  TipSeries series;
  series.what = "made";
  series.tool.marker_count = 4;
  series.stated.camera.correlated_range_m = series.stated.camera.correlated_centroid_px = 0;
  series.stated.head.rest_position_m = 0.001;
  const sim::RandomKey key{7, sim::Stream::reference};
  std::uint64_t drawn = 0;
  double t = 0;
  for (int touch = 0; touch <= made.touches; ++touch) {
    const bool rests = touch == made.touches;
    const double side = 2.4 * touch, lean = made.lean_rad * (0.5 + 0.5 * std::cos(1.7 * touch));
    const Quaternion rotation =
        from_rotation_vector(lean * Vector3(std::cos(side), std::sin(side), 0.8 * std::sin(touch)));
    const Matrix3 view =
        from_rotation_vector(0.5 * Vector3(0, std::sin(side), std::cos(side))).toRotationMatrix();
    const Vector3 point =
        touch % 3 == 2 && !rests ? Vector3(0, made.distance_m, 0) : Vector3::Zero();
    const double begin = t;
    for (; t < begin + (rests ? made.rest_s : made.touch_s); t += 1 / 45.0) {
      TipObservation one;
      one.time = Time{static_cast<std::int64_t>(1e9 * t)};
      one.rotation = rotation;
      one.random_m2 = k_made_noise_m * k_made_noise_m * Matrix3::Identity();
      one.by_calibration.col(0) = 0.005 * view.col(2);
      one.by_calibration.col(2) = 0.005 * view.col(0);
      one.by_calibration.col(3) = 0.005 * view.col(1);
      one.by_head.leftCols<3>() = series.stated.head.rest_position_m * Matrix3::Identity();
      one.tip_m = point + made.errors.x() * one.by_calibration.col(0) +
                  made.errors.y() * one.by_calibration.col(2) +
                  made.errors.z() * one.by_calibration.col(3) +
                  k_made_noise_m * sim::gaussian_vector(key, drawn++);
      if (made.drift) one.tip_m += made.drift(rests ? -1 : touch, t - begin);
      one.centroid_m = one.tip_m + rotation * Vector3(0, 0, 0.15);
      one.range_m = 0.5;
      series.observations.push_back(one);
    }
    t += 1;
  }
  series.frames = static_cast<int>(series.observations.size());
  return series;
}

}  // namespace glint::test
