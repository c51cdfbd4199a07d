// A blob to a candidate marker: its ray, and the range to the surface that the camera sees.
//
// What:     ray of the centroid (the seed's m = (Z x / f, Z y / f, Z) for a pinhole, divided by its
//           length); range: the median over the blob's inner half of valid, unsaturated depth
//           pixels, then the mean of those near it. Each is first taken back to the front point of
//           a sphere with the nominal radius: a pixel s beside the ray through the middle sees the
//           sphere r - sqrt(r^2 - s^2) further away. Centre saturated or without depth: the same
//           over the ring between the inner half and the rim. z depth becomes radial by each
//           pixel's own ray. A range that has wrapped is told by the blob's size; what is known of
//           the sensor's bias on such markers is taken off. With range and radius the centroid is
//           moved to where the sphere's centre projects; both get a sigma: the blob's, and that of
//           the ranges' mean by their number and spread.
// Cost:     a ray for each blob, and what depth_samples.hpp and robust_mean.hpp say, its
//           inliers averaged twice if wrapped. All blobs together look at no more pixels and
//           average no more samples than `limits` says; each may have its share, and what the
//           others leave.
// Worst:    as many large blobs as there may be, their middles saturated, their ranges wrapped, at
//           the rim of a wide lens.
// Accuracy: noise of one pixel / sqrt(samples); bias on a sphere of the nominal radius 0.1 mm, by
//           the ring 1 mm, by that of a sphere saturated all over 1.5 to 5 mm, of which the sigma
//           holds 3.5; smeared by 2 px 0.1 to 0.9 mm, of which it holds nothing (`glint experiment
//           centroid`). A disc taken for a sphere comes out 0.14 of the nominal radius short.
// Source:   the seed, section III; AHAT's wrap: hl2ss, "alias".
#pragma once

#include <algorithm>

#include "kernels/image/blob.hpp"
#include "kernels/image/frame.hpp"
#include "kernels/nonblocking.hpp"
#include "kernels/pose/camera_model.hpp"
#include "kernels/pose/depth_settings.hpp"
#include "kernels/pose/local_rays.hpp"
#include "kernels/pose/marker.hpp"
#include "kernels/pose/robust_mean.hpp"
#include "kernels/pose/sphere_shift.hpp"
#include "kernels/pose/tool.hpp"

namespace glint {

// The size of marker that is looked for before it is known whose it is; of several tools' markers
// one in the middle. Radius 0: neither is depth taken back to the front point nor a wrap searched.
struct NominalMarker {
  double radius_m = 0.006;
  MarkerShape shape = MarkerShape::sphere;
};

// What one blob may take: pixels looked at for depth, samples averaged, steps to find its ray.
struct MarkerWorkLimits {
  int pixels = k_blobs_max * k_range_pixels_a_blob;
  int samples = k_blobs_max * k_range_samples_a_blob;
  int ray_steps = k_ray_steps_max;
};

// blob_index: its place in Blobs. shift: the camera's sphere_shift(); {} takes nothing off. True:
// out has a ray; without any depth k_marker_no_depth is set and surface_range_m is 0. False: the
// lens has no ray for the centroid. surface_range_m: radial, from the camera to the marker's front
// point along the centroid's ray.
[[nodiscard]] bool measure_marker(const Frame& frame, const Blob& blob, std::uint16_t blob_index,
                                  const CameraModel& camera, const SphereShift& shift,
                                  const DepthSettings& depth, const NominalMarker& nominal,
                                  Marker& out,
                                  const MarkerWorkLimits& most = {}) noexcept GLINT_NONBLOCKING;

// How often the loops ran.
struct BackProjectWork {
  std::int32_t blobs = 0;
  std::int32_t lens_steps = 0;
  std::int32_t pixels = 0;     // looked at
  std::int32_t samples = 0;    // averaged
  std::int32_t unwrapped = 0;  // samples averaged again
};

// Every blob's marker, in the blobs' order; those without a ray are left out. Blobs beyond
// limits.blobs are not looked at.
BackProjectWork back_project(const Frame& frame, const Blobs& blobs, const CameraModel& camera,
                             const SphereShift& shift, const DepthSettings& depth,
                             const NominalMarker& nominal, Markers& out,
                             const Limits& limits = {}) noexcept GLINT_NONBLOCKING;

// What back_project may do at most.
[[nodiscard]] constexpr BackProjectWork back_project_work_max(const Limits& limits) {
  const int samples = limits.blobs * limits.range_samples_a_blob;
  return {limits.blobs, limits.blobs * limits.ray_steps, limits.blobs * limits.range_pixels_a_blob,
          samples, samples};
}

// Pixels that a sphere (or a disc that faces the camera) of this radius covers around a pixel with
// its centre at this range (metres, radial): its solid angle over the pixel's. 0: no ray there.
[[nodiscard]] double expected_area_px(const CameraModel& camera, const Vector2& pixel,
                                      double radius_m, double range_m) noexcept GLINT_NONBLOCKING;

}  // namespace glint
