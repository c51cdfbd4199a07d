// Candidate marker: a blob's ray and range in the camera's frame.
#pragma once

#include <array>
#include <cstdint>

#include "kernels/geometry.hpp"
#include "kernels/limits.hpp"
#include "kernels/reason.hpp"

namespace glint {

enum MarkerFlag : std::uint8_t {
  k_marker_no_depth = 1,       // no range from inner disc or annulus: never labelled
  k_marker_annulus_depth = 2,  // centre saturated or without depth; range from the annulus
  k_marker_wrapped = 4,        // range was wrapped and has been unwrapped
  k_marker_saturated = 8,
  k_marker_touches_edge = 16,
  k_marker_has_neighbour = 32,  // light of another blob at two pixels' distance
  k_marker_not_isolated = 64,   // box or area is not one marker's: merged, or partially occluded
};

// The marker's surface point is ray * surface_range_m. A sphere's centre is its radius farther
// along the ray, a disc's is at the surface; the tool defines the shape.
struct Marker {
  Vector3 ray = Vector3::UnitZ();  // unit, camera frame
  // Change of the ray per pixel of the centroid, perpendicular to it. Zero: unknown, e.g. for a
  // point without an image.
  Vector3 along_x = Vector3::Zero(), along_y = Vector3::Zero();
  double surface_range_m = 0;             // radial, along the ray
  Vector2 centroid_px = Vector2::Zero();  // of a sphere: projection of its centre
  std::uint32_t area_px = 0;
  std::uint16_t blob = 0;  // index into Blobs
  std::uint8_t flags = 0;  // MarkerFlag
  // Sigmas of the centroid along x and y, and of the range: this marker's own part, from its
  // pixels. Errors common to all of its pixels are not included. 0: unknown.
  std::array<float, 2> sigma_px{};
  float range_sigma_m = 0;
  float bias_subtracted_m = 0;  // the camera's depth bias, already subtracted from surface_range_m
  std::uint16_t peak = 0;       // the brightest pixel, raw; 0: a point without an image
};

struct Markers {
  std::array<Marker, k_blobs_max> items;
  int count = 0;
  // Why markers of the frame may be missing here: blobs_full, runs_full.
  Reason incomplete = Reason::none;
};

}  // namespace glint
