// A blob with a range: one candidate marker in the camera's frame.
#pragma once

#include <array>
#include <cstdint>

#include "kernels/geometry.hpp"
#include "kernels/limits.hpp"
#include "kernels/reason.hpp"

namespace glint {

enum MarkerFlag : std::uint8_t {
  k_marker_no_depth = 1,    // neither the centre nor the ring gave a range: never labelled
  k_marker_ring_depth = 2,  // the centre was saturated or zero; the range is the ring's
  k_marker_wrapped = 4,     // the range was found to have wrapped and was unwrapped
  k_marker_saturated = 8,
  k_marker_touches_edge = 16,
  k_marker_has_neighbour = 32,  // another blob's light lies two pixels beside it
  k_marker_uneven = 64,         // no whole marker by its box or area: merged, or partly hidden
};

// The marker's surface point is ray * surface_range_m. A sphere's centre lies its radius further
// along the ray, a disc's at the surface: which of the two is the tool's affair.
struct Marker {
  Vector3 ray = Vector3::UnitZ();  // unit, camera frame
  // How the ray turns where the centroid moves by a pixel, at right angles to it. Zero: not known,
  // as of a point without an image.
  Vector3 along_x = Vector3::Zero(), along_y = Vector3::Zero();
  double surface_range_m = 0;             // radial, along the ray
  Vector2 centroid_px = Vector2::Zero();  // of a sphere: where its centre projects
  std::uint32_t area_px = 0;
  std::uint16_t blob = 0;  // index into Blobs
  std::uint8_t flags = 0;  // MarkerFlag
  // Of the centroid along x and y, and of the range: this marker's own share, as its pixels tell.
  // What is common to all of a marker's pixels comes on top. 0: not known.
  std::array<float, 2> sigma_px{};
  float range_sigma_m = 0;
  float bias_taken_m = 0;  // off surface_range_m: the camera's depth bias
  std::uint16_t peak = 0;  // the brightest pixel, raw; 0: of a point without an image
};

struct Markers {
  std::array<Marker, k_blobs_max> items;
  int count = 0;
  // Why markers of the frame may be missing here: blobs_full, runs_full.
  Reason incomplete = Reason::none;
};

}  // namespace glint
