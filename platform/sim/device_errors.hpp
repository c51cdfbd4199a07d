// What a real device and its markers differ by from what their calibration states: errors that a
// tracker is not given and that do not average out over frames.
//
// Sources: HoloLens 2 units: their markers' ranges, their tools at rest (kernels/pose/
//          systematic_covariance.hpp has the figures);
//          range error with a period over the range: Foix, Alenya, Torras, "Lock-in Time-of-Flight
//          (ToF) Cameras: A Survey", IEEE Sensors Journal 11 (2011), section II.
#pragma once

#include <cstdint>

#include "kernels/geometry.hpp"
#include "kernels/units.hpp"
#include "platform/sim/random.hpp"

namespace glint::sim {

struct DeviceErrors {
  bool exists = false;  // false: the device is what its calibration states
  Vector2 principal_point_px = Vector2::Zero();
  double focal_scale = 0;
  double lens_residual_px = 0;  // rms of a smooth field over the image, an axis
  double range_offset_m = 0;
  double range_scale = 0;
  double range_wiggle_m = 0;  // amplitude; one period each k_wiggle_period_m of range
  // Of each marker, rms: a sum of slow oscillations, k_slowest_hz to k_fastest_hz.
  double correlated_range_m = 0, correlated_centroid_px = 0;
  double dim_m = 0;  // range error of a marker with k_reference_counts, as DepthBias::dim_m
  // Optical errors (stray_light.hpp): share of the light that each of four neighbours, the halo and
  // all pixels together receive.
  double spread_share = 0, halo_share = 0, stray_share = 0;
  double stray_detour_m = 0;  // additional path of stray light, as range
  int hot_pixels = 0;
  std::uint64_t seed = 0;
};
inline constexpr double k_wiggle_period_m = 0.26;  // a quarter of AHAT's wrap
inline constexpr double k_slowest_hz = 0.01, k_fastest_hz = 0.5;

struct MarkerError {
  Vector2 shift_px = Vector2::Zero();
  double range_m = 0;
};

// Of a marker whose image lies at `pixel`; number: its own among all markers.
[[nodiscard]] MarkerError marker_error(const DeviceErrors& device, const Vector2& pixel,
                                       const Vector2& principal_point_px, double range_m,
                                       std::uint64_t number, Time time);

}  // namespace glint::sim
