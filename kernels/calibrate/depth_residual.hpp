// Residual of a depth calibration: a marker's pixel and range against a tool of known geometry,
// with unknown depth bias and pose.
//
// What:     across the ray the marker's pixel minus the measured one, by the lens's linear map
//           around it; along the ray the range that the sensor would report, including bias, minus
//           the measured one. All three divided by their sigma.
// Cost:     one quaternion product, a square root; no loop.
// Worst:    a marker perpendicular to its measured ray; does not occur. Requires positive sigmas
//           and per_metre below 1.
// Accuracy: the lens is linearised: 1e-4 of the residual within a pixel.
// Source:   Lindner, Schiller, Kolb, Koch, "Time-of-Flight sensor calibration for accurate range
//           sensing", Computer Vision and Image Understanding 114 (2010), section 4: distance and
//           brightness errors against the pose from the image; here the pose is unknown as well.
#pragma once

#include <cmath>

#include "kernels/calibrate/scalar.hpp"
#include "kernels/pose/depth_bias.hpp"

namespace glint {

// The unknowns of DepthBias, in its order.
inline constexpr int k_depth_unknowns = 3;

struct DepthSample {
  Vector3 marker_m = Vector3::Zero();  // tool frame
  Vector3 ray = Vector3::UnitZ();      // measured, unit, camera frame
  // (per_x . p) / (ray . p) is the pixel of p minus the measured one; perpendicular to the ray.
  Vector3 per_x = Vector3::Zero(), per_y = Vector3::Zero();
  double surface_range_m = 0;  // as reported by the sensor
  double centre_behind_m = 0;  // from the surface to the marker's centre
  double inverse_signal = 0;   // k_reference_counts / peak; 0: term not used
  double sigma_x_px = 1, sigma_y_px = 1, sigma_range_m = 1;
};

// bias: offset_m, per_metre, low_signal_m.
template <class Scalar>
[[nodiscard]] Vector3Of<Scalar> depth_residual(const DepthSample& sample,
                                               const QuaternionOf<Scalar>& rotation,
                                               const Vector3Of<Scalar>& translation_m,
                                               const Vector3Of<Scalar>& bias) noexcept {
  using std::sqrt;
  const Vector3Of<Scalar> p =
      rotated<Scalar>(rotation, sample.marker_m.cast<Scalar>()) + translation_m;
  const Scalar along = p.dot(sample.ray.cast<Scalar>());
  // Sensor model: range = surface + bias(range), with the surface predicted by the pose. With the
  // measured range on both sides its noise would bias the slope upwards.
  const Scalar surface = sqrt(p.squaredNorm()) - sample.centre_behind_m;
  const Scalar range =
      (surface + bias[0] - bias[1] * DepthBias::k_reference_m + bias[2] * sample.inverse_signal) /
      (Scalar(1) - bias[1]);
  return {p.dot(sample.per_x.cast<Scalar>()) / along / sample.sigma_x_px,
          p.dot(sample.per_y.cast<Scalar>()) / along / sample.sigma_y_px,
          (range - sample.surface_range_m) / sample.sigma_range_m};
}

}  // namespace glint
