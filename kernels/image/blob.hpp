// Blob: connected component of pixels above the threshold, the image of a marker, hand or lamp.
#pragma once

#include <array>
#include <cstdint>

#include "kernels/geometry.hpp"
#include "kernels/limits.hpp"
#include "kernels/reason.hpp"

namespace glint {

enum BlobFlag : std::uint8_t {
  k_blob_touches_edge = 1,       // cut by the frame's border
  k_blob_saturated = 2,          // at least one pixel at the sensor's maximum
  k_blob_has_neighbour = 4,      // light of another blob two pixels beside it
  k_blob_partial_or_merged = 8,  // box is not that of a complete disc: merged or partially occluded
};

struct Blob {
  Vector2 centroid_px = Vector2::Zero();  // pixel centres at integer + 0.5
  std::uint32_t area_px = 0;  // pixels above the threshold, or above the level of a rescan
  std::uint16_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;  // bounding box, half open
  std::uint16_t peak = 0;                        // brightest reflectivity, raw
  std::uint8_t flags = 0;                        // BlobFlag
  // Variance of the centroid in x and y, px^2, from the blob's pixels alone. Errors of the lens
  // calibration, which move the complete blob, are not included.
  std::array<float, 2> variance_px2{};
};

struct Blobs {
  std::array<Blob, k_blobs_max> items;  // in row order: top first, then left first
  int count = 0;
  std::uint32_t dropped = 0;   // beyond the budget, outside the size gate, or of low contrast
  std::uint32_t left_out = 0;  // of these, the ones inside the gate: another frame may keep them
  // blobs_full also if all blobs are kept, but the budget for their centroids was too small.
  Reason reason = Reason::none;
  // Why blobs inside the gate may be missing: runs_full, or blobs_full by left_out.
  Reason incomplete = Reason::none;
};

}  // namespace glint
