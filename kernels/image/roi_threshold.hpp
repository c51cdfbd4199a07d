// Thresholding of the regions of interest, with run-length encoding.
//
// What:     every pixel with reflectivity > threshold inside any ROI, as runs in row-major order;
//           adjacent runs are joined, also across the border of two ROIs.
// Cost:     one pass over the ROIs' pixels, in blocks of 64 bytes, and two writes a run. A run
//           beyond the buffer ends the pass with Reason::runs_full; `limits` states the buffer's
//           capacity.
// Worst:    as many ROIs side by side as tools, and exactly as many runs as fit, so that the last
//           block is still read.
// Accuracy: exact; integers only, so that vector code gives equal bits.
// Source:   Puljiz et al., section III: reflectivity above 250 inside an ROI.
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

// Loop counts of one call.
struct ThresholdWork {
  std::int32_t stretches = 0;  // ROIs times rows of the band
  std::int32_t blocks = 0;     // of 64 bytes
  std::int32_t runs = 0;
};

// Clips ROIs to the frame; overlaps count once. More ROIs than limits.tools become one that covers
// the frame. A frame beyond `limits` yields no runs. Units of frame and threshold: raw counts.
ThresholdWork threshold_runs(const Frame& frame, const Rois& rois, std::uint16_t threshold,
                             RowBand band, Runs& out,
                             const Limits& limits = {}) noexcept GLINT_NONBLOCKING;

// Reference implementation, pixel by pixel and without shared code, for the tests.
void threshold_runs_reference(const Frame& frame, const Rois& rois, std::uint16_t threshold,
                              RowBand band, Runs& out, const Limits& limits = {}) noexcept;

// Maximum loop counts of threshold_runs in the largest of `band_count` bands.
[[nodiscard]] constexpr ThresholdWork threshold_work_max(const Limits& limits, int band_count) {
  const int rows = (limits.height + band_count - 1) / band_count;
  const int rois = std::clamp(limits.tools, 1, limits.width);
  const int block = 64 / limits.reflectivity_bytes;
  // A row segment of 1 + n * block pixels takes n + 1 blocks: the worst case for each ROI.
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
