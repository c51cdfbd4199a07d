// Where a blob's middle is, to a hundredth of a pixel.
//
// What:     grown_centroid: mean position weighted by reflectivity over the blob grown by one
//           pixel, less the background, which is the mean of the dark pixels one further out.
//           weighted_centroid: weighted by reflectivity above the threshold over the blob itself.
//           binary_centroid: the plain mean of the blob's pixels.
// Cost:     grown: the same for each eight columns of a row of the grown box, and linear in the
//           blob's runs; binary: linear in the blob's runs; weighted: in its pixels.
// Worst:    a box of k_grown_box_max squared pixels.
// Accuracy: discs of 4 to 10 px: 0.01 px rms an axis grown, 0.02 to 0.05 weighted, 0.07 to 0.09
//           binary. All sums are integers and so exact in any order.
// Source:   the first moment; growing the mask catches the half-lit rim that the threshold cuts
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
  // Of the grown blob, raw; binary: of its runs' ends and middles.
  std::uint16_t peak = 0;
  bool beside_bright = false;  // a pixel around the grown blob is above the threshold
  // What its variance follows from; all 0 where it is not the grown centroid.
  double light = 0;       // sum of reflectivity less the background
  double background = 0;  // of a pixel
  std::int32_t pixels = 0, dark_pixels = 0;
  Vector2 lever_px = Vector2::Zero();  // sum of the pixels' offsets from the position
};

// A larger box falls back to binary_centroid; a background as bright as the blob, to its position.
[[nodiscard]] Centroid grown_centroid(const Frame& frame, const BlobScratch& scratch,
                                      const Component& component,
                                      std::uint16_t threshold) noexcept GLINT_NONBLOCKING;

[[nodiscard]] Centroid weighted_centroid(const Frame& frame, const BlobScratch& scratch,
                                         const Component& component,
                                         std::uint16_t threshold) noexcept;

[[nodiscard]] Centroid binary_centroid(const Frame& frame, const BlobScratch& scratch,
                                       const Component& component) noexcept GLINT_NONBLOCKING;

}  // namespace glint
