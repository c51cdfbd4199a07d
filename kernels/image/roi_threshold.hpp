// Bright pixels inside the regions of interest, run-length coded.
//
// What:     every pixel with reflectivity > threshold inside any ROI, as runs by rows, then from
//           left to right; runs that touch are one run, also across the border of two ROIs.
// Cost:     one pass over the ROIs' pixels; a row with a bright pixel is looked at twice.
// Worst:    every second pixel bright: the buffer fills, the rest is counted and
//           Reason::runs_full says so.
// Accuracy: exact; integers only, so that vector code gives equal bits.
// Source:   the seed, section III: reflectivity above 250 inside an ROI.
#pragma once

#include <cstdint>

#include "kernels/image/frame.hpp"
#include "kernels/image/roi.hpp"
#include "kernels/image/run.hpp"

namespace glint {

// The rows height * index / count <= y < height * (index + 1) / count.
struct RowBand {
  int index = 0;
  int count = 1;
};

// ROIs are clipped to the frame; where they overlap they count once. Frame, threshold: raw counts.
void threshold_runs(const Frame& frame, const Rois& rois, std::uint16_t threshold, RowBand band,
                    Runs& out) noexcept;

// The same, pixel by pixel: what the faster one is compared with.
void threshold_runs_reference(const Frame& frame, const Rois& rois, std::uint16_t threshold,
                              RowBand band, Runs& out) noexcept;

// One ROI that covers the frame.
[[nodiscard]] inline Rois whole_frame(const Frame& frame) noexcept {
  Rois rois;
  rois.items[0] = {0, 0, frame.width(), frame.height()};
  rois.count = 1;
  return rois;
}

}  // namespace glint
