// What is left between a marker's measured pixel and range and those of a tool of known size, the
// sensor's depth bias unknown.
//
// What:     across the ray the marker's pixel less the measured one, by the lens's linear map
//           around it; along it the range that the sensor would state, bias and all, less the
//           measured one. All three in sigmas.
// Cost:     one quaternion product, a square root; no loop.
// Worst:    a marker at right angles to its measured ray; none comes near. Sigmas must be
//           positive, per_metre below 1.
// Accuracy: the lens's curvature over the residual, 1e-4 of it within a pixel.
// Source:   Lindner, Schiller, Kolb, Koch, "Time-of-Flight sensor calibration for accurate range
//           sensing", Computer Vision and Image Understanding 114 (2010), section 4: distance and
//           brightness errors against the pose that the picture gives; here the pose is unknown
//           beside them.
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
  // (per_x . p) / (ray . p) is the pixel of p less the measured one; at right angles to the ray.
  Vector3 per_x = Vector3::Zero(), per_y = Vector3::Zero();
  double surface_range_m = 0;  // as the sensor has it
  double centre_behind_m = 0;  // from the surface to the marker's centre
  double dimness = 0;          // k_reference_counts by the peak; 0: not asked for
  double sigma_x_px = 1, sigma_y_px = 1, sigma_range_m = 1;
};

// bias: offset_m, per_metre, dim_m.
template <class Scalar>
[[nodiscard]] Vector3Of<Scalar> depth_residual(const DepthSample& sample,
                                               const QuaternionOf<Scalar>& rotation,
                                               const Vector3Of<Scalar>& translation_m,
                                               const Vector3Of<Scalar>& bias) noexcept {
  using std::sqrt;
  const Vector3Of<Scalar> p =
      rotated<Scalar>(rotation, sample.marker_m.cast<Scalar>()) + translation_m;
  const Scalar along = p.dot(sample.ray.cast<Scalar>());
  // The sensor states range = surface + bias(range). By the range that the pose gives, not by the
  // measured one: its noise in both would draw the slope upwards.
  const Scalar surface = sqrt(p.squaredNorm()) - sample.centre_behind_m;
  const Scalar range =
      (surface + bias[0] - bias[1] * DepthBias::k_reference_m + bias[2] * sample.dimness) /
      (Scalar(1) - bias[1]);
  return {p.dot(sample.per_x.cast<Scalar>()) / along / sample.sigma_x_px,
          p.dot(sample.per_y.cast<Scalar>()) / along / sample.sigma_y_px,
          (range - sample.surface_range_m) / sample.sigma_range_m};
}

}  // namespace glint
