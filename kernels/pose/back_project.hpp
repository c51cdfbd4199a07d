// Back-projection of a blob to a candidate marker: its ray, and the range to the visible surface.
//
// What:     the ray of the centroid (for a pinhole m = (Z x / f, Z y / f, Z) of Puljiz et al.,
//           divided by its length). The range: the median of the valid, unsaturated depth pixels in
//           the blob's inner disc, then the mean of those near it. Each depth is first reduced to
//           the nearest surface point of a sphere with the nominal radius: a pixel s beside the ray
//           through the centre sees the sphere r - sqrt(r^2 - s^2) farther away. If the centre is
//           saturated or without depth, the annulus between inner disc and rim replaces it. z depth
//           becomes radial by each pixel's own ray. The blob's size detects a wrapped range; the
//           sensor's depth bias on such markers is subtracted. With range and radius, the centroid
//           is moved to the projection of the sphere's centre. The centroid's sigma is the blob's;
//           the range's is that of the mean, from number and spread of the ranges.
// Cost:     one ray per blob; depth_samples.hpp and robust_mean.hpp, with the inliers averaged
//           twice if wrapped. `limits` bounds the pixels read and the samples averaged by all blobs
//           together. Each blob may use its share and what the others leave.
// Worst:    the capacity of large blobs, saturated at the centre, with wrapped ranges, at the rim
//           of a wide lens.
// Accuracy: noise of one pixel / sqrt(samples). Bias on a sphere of the nominal radius: 0.1 mm;
//           from the annulus 1 mm; from the annulus of a fully saturated sphere 1.5 to 5 mm, of
//           which the sigma covers 3.5 mm. Motion blur of 2 px adds 0.1 to 0.9 mm, which the sigma
//           does not cover (`glint experiment centroid`). The range of a disc treated as a sphere
//           is too short by 0.14 of the nominal radius.
// Source:   Puljiz et al., section III; AHAT's wrap: hl2ss, "alias".
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

// Marker size assumed before a labeling assigns the marker to a tool; a medium one if the tools'
// sizes differ. Radius 0 disables the reduction to the nearest surface point and the wrap
// detection.
struct NominalMarker {
  double radius_m = 0.006;
  MarkerShape shape = MarkerShape::sphere;
};

// Budget of one blob: depth pixels read, samples averaged, lens steps for its ray.
struct MarkerWorkLimits {
  int pixels = k_blobs_max * k_range_pixels_per_blob;
  int samples = k_blobs_max * k_range_samples_per_blob;
  int ray_steps = k_ray_steps_max;
};

// Returns true if `out` has a ray, false if the lens has no ray for the centroid. blob_index: index
// into Blobs. shift: the camera's sphere_offset(); {} subtracts nothing. Without any depth,
// k_marker_no_depth is set and surface_range_m is 0. surface_range_m: metres, radial, from the
// camera to the marker's nearest surface point along the centroid's ray.
[[nodiscard]] bool measure_marker(const Frame& frame, const Blob& blob, std::uint16_t blob_index,
                                  const CameraModel& camera, const SphereOffset& shift,
                                  const DepthSettings& depth, const NominalMarker& nominal,
                                  Marker& out,
                                  const MarkerWorkLimits& limits = {}) noexcept GLINT_NONBLOCKING;

// Loop counts.
struct BackProjectWork {
  std::int32_t blobs = 0;
  std::int32_t lens_steps = 0;
  std::int32_t pixels = 0;     // read
  std::int32_t samples = 0;    // averaged
  std::int32_t unwrapped = 0;  // samples averaged again
};

// Computes the marker of every blob, in the blobs' order; a blob without a ray gives none. Ignores
// blobs beyond limits.blobs.
BackProjectWork back_project(const Frame& frame, const Blobs& blobs, const CameraModel& camera,
                             const SphereOffset& shift, const DepthSettings& depth,
                             const NominalMarker& nominal, Markers& out,
                             const Limits& limits = {}) noexcept GLINT_NONBLOCKING;

// Upper bound of back_project's loop counts.
[[nodiscard]] constexpr BackProjectWork back_project_work_max(const Limits& limits) {
  const int samples = limits.blobs * limits.range_samples_per_blob;
  return {limits.blobs, limits.blobs * limits.ray_steps,
          limits.blobs * limits.range_pixels_per_blob, samples, samples};
}

// Returns the image area in pixels of a sphere (or of a disc that faces the camera) with its centre
// at this pixel and range (metres, radial): its solid angle divided by the pixel's. 0: no ray
// there.
[[nodiscard]] double expected_area_px(const CameraModel& camera, const Vector2& pixel,
                                      double radius_m, double range_m) noexcept GLINT_NONBLOCKING;

}  // namespace glint
