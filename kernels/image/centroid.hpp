// Sub-pixel centroid of a blob: first moment of reflectivity, with background subtraction.
//
// What:     grown_centroid: mean position over the blob grown by one pixel, weighted by
//           reflectivity minus the background (mean of the dark pixels one further out).
//           weighted_centroid: over the blob itself, weighted by reflectivity above the threshold.
//           binary_centroid: the plain mean of the blob's pixels.
// Cost:     grown: the same for each eight columns of a row of the grown box, and linear in the
//           blob's runs; binary: linear in the blob's runs; weighted: in its pixels.
// Worst:    a box of k_grown_box_max squared pixels.
// Accuracy: discs of 4 to 10 px: 0.01 px rms an axis grown, 0.02 to 0.05 weighted, 0.07 to 0.09
//           binary. All sums are integers and so exact in any order.
// Source:   the first moment; growing the mask includes the half-lit rim that the threshold cuts
//           off.
#pragma once

#include "kernels/geometry.hpp"
#include "kernels/image/blob_scratch.hpp"
#include "kernels/image/frame.hpp"
#include "kernels/image/grown_box.hpp"
#include "kernels/nonblocking.hpp"

namespace glint {

struct Centroid {
  Vector2 position_px = Vector2::Zero();  // pixel centres at integer + 0.5
  // Maximum over the grown blob, raw; binary_centroid: over the ends and centres of its runs.
  std::uint16_t peak = 0;
  bool has_bright_rim = false;  // a pixel around the grown blob is above the threshold
  // Input of centroid_variance(); all 0 unless this is a grown centroid.
  double intensity_sum = 0;  // sum of reflectivity minus the background
  double background = 0;     // mean of a pixel, raw
  std::int32_t pixels = 0, dark_pixels = 0;
  Vector2 lever_px = Vector2::Zero();  // sum of the pixels' offsets from the position
};

// Returns binary_centroid if the box exceeds k_grown_box_max, and its position if the background is
// as bright as the blob or the centroid is outside the blob's box.
[[nodiscard]] Centroid grown_centroid(const Frame& frame, const BlobScratch& scratch,
                                      const Component& component,
                                      std::uint16_t threshold) noexcept GLINT_NONBLOCKING;

[[nodiscard]] Centroid weighted_centroid(const Frame& frame, const BlobScratch& scratch,
                                         const Component& component,
                                         std::uint16_t threshold) noexcept;

[[nodiscard]] Centroid binary_centroid(const Frame& frame, const BlobScratch& scratch,
                                       const Component& component) noexcept GLINT_NONBLOCKING;

}  // namespace glint
