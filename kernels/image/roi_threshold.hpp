// Bright pixels inside the regions of interest, run-length coded.
//
// What:     every pixel with reflectivity > threshold inside any ROI, as runs by rows, then from
//           left to right; runs that touch are one run, also across the border of two ROIs.
// Cost:     one pass over the ROIs' pixels, in blocks of 64 bytes, and two writes a run; what is
//           bright beyond the buffer ends it, and Reason::runs_full says so. The runs' buffer is as
//           long as `limits` says.
// Worst:    as many ROIs side by side as there are tools, and just as many runs as fit, so that the
//           last block is still looked at.
// Accuracy: exact; integers only, so that vector code gives equal bits.
// Source:   the seed, section III: reflectivity above 250 inside an ROI.
#pragma once

#include <algorithm>
#include <cstdint>

#include "kernels/image/frame.hpp"
#include "kernels/image/roi.hpp"
#include "kernels/image/run.hpp"
#include "kernels/nonblocking.hpp"

namespace glint {

// The rows height * index / count <= y < height * (index + 1) / count.
struct RowBand {
  int index = 0;
  int count = 1;
};

// How often its loops ran.
struct ThresholdWork {
  std::int32_t stretches = 0;  // ROIs times rows of the band
  std::int32_t blocks = 0;     // of 64 bytes
  std::int32_t runs = 0;
};

// ROIs are clipped to the frame; where they overlap they count once. More of them than there may be
// tools become one that covers the frame. Nothing is searched in a frame beyond `limits`. Frame,
// threshold: raw counts.
ThresholdWork threshold_runs(const Frame& frame, const Rois& rois, std::uint16_t threshold,
                             RowBand band, Runs& out,
                             const Limits& limits = {}) noexcept GLINT_NONBLOCKING;

// The same, pixel by pixel, in code of its own: the tests compare the faster one with it.
void threshold_runs_reference(const Frame& frame, const Rois& rois, std::uint16_t threshold,
                              RowBand band, Runs& out, const Limits& limits = {}) noexcept;

// What threshold_runs may do at most, in the largest of `band_count` bands.
[[nodiscard]] constexpr ThresholdWork threshold_work_max(const Limits& limits, int band_count) {
  const int rows = (limits.height + band_count - 1) / band_count;
  const int rois = std::clamp(limits.tools, 1, limits.width);
  const int block = 64 / limits.reflectivity_bytes;
  // A stretch of 1 + n block pixels takes n + 1 blocks: that many, where each has one pixel more.
  const int blocks = (limits.width - rois) / block + rois;
  const int runs = std::min(limits.runs_per_band, rows * ((limits.width + 1) / 2));
  return {rows * rois, rows * blocks, runs};
}

// One ROI that covers the frame.
[[nodiscard]] inline Rois whole_frame(const Frame& frame) noexcept {
  Rois rois;
  rois.items[0] = {0, 0, frame.width(), frame.height()};
  rois.count = 1;
  return rois;
}

}  // namespace glint
