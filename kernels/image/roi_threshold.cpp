#include "kernels/image/roi_threshold.hpp"

#include <algorithm>
#include <cstddef>

#include "kernels/image/bright_mask.hpp"
#include "kernels/image/run_writer.hpp"

namespace glint {
namespace {

// The ROIs clipped to the rows of this band, sorted from left to right (a total order).
Rois clipped(const Rois& rois, const Limits& limits, int width, int top, int bottom) {
  Rois out;
  const int most = std::clamp(limits.tools, 1, static_cast<int>(rois.items.size()));
  if (rois.count > most) {
    out.items[0] = {0, top, width, bottom};
    out.count = 1;
    return out;
  }
  const int count = std::max(rois.count, 0);
  for (int i = 0; i < count; ++i) {
    const Roi& roi = rois.items[static_cast<std::size_t>(i)];
    const Roi cut{std::max(roi.x0, 0), std::max(roi.y0, top), std::min(roi.x1, width),
                  std::min(roi.y1, bottom)};
    if (cut.x0 >= cut.x1 || cut.y0 >= cut.y1) continue;
    int at = out.count++;
    for (; at > 0; --at) {
      const Roi& before = out.items[static_cast<std::size_t>(at - 1)];
      if (before.x0 < cut.x0 || (before.x0 == cut.x0 && before.y0 <= cut.y0)) break;
      out.items[static_cast<std::size_t>(at)] = before;
    }
    out.items[static_cast<std::size_t>(at)] = cut;
  }
  return out;
}

// Calls scan(pixels of the row, y, x0, x1) for each row segment inside an ROI until it returns
// false. Returns the number of ROIs times rows.
template <class Pixel, class Scan>
int for_each_row_segment(const ImageView<Pixel>& image, const Rois& rois, const Limits& limits,
                         RowBand band, Scan scan) {
  const int top = image.height * band.index / band.count;
  const int bottom = image.height * (band.index + 1) / band.count;
  const Rois cut = clipped(rois, limits, image.width, top, bottom);
  for (int y = top; y < bottom; ++y) {
    int end = 0;
    for (int i = 0; i < cut.count; ++i) {
      const Roi& roi = cut.items[static_cast<std::size_t>(i)];
      if (y < roi.y0 || y >= roi.y1) continue;
      const int x0 = std::max(roi.x0, end);
      if (x0 < roi.x1 && !scan(image.row(y), y, x0, roi.x1)) return (y + 1 - top) * cut.count;
      end = std::max(end, roi.x1);
    }
  }
  return (bottom - top) * cut.count;
}

bool is_valid_input(const Frame& frame, RowBand band, const Limits& limits) {
  const int bytes = frame.reflectivity_16.empty() ? 1 : 2;
  return band.count > 0 && band.index >= 0 && band.index < band.count &&
         frame.width() <= std::min(limits.width, k_width_max) &&
         frame.height() <= std::min(limits.height, k_height_max) &&
         bytes <= limits.reflectivity_bytes;
}

// Rows to prefetch: the hardware prefetcher does not follow a narrow ROI from row to row. Software
// prefetch hides the memory latency of a frame that is not in a cache yet.
constexpr int k_rows_ahead = 12;

template <class Pixel>
ThresholdWork scan_fast(const ImageView<Pixel>& image, const Rois& rois, const Limits& limits,
                        Pixel threshold, RowBand band, RunWriter& writer) {
  constexpr int block = k_mask_pixels<Pixel>;
  ThresholdWork work;
  const auto scan = [&](const Pixel* row, int y, int x0, int x1) {
    work.blocks += (x1 - x0 + block - 1) / block;
    const Pixel* ahead = image.row(std::min(y + k_rows_ahead, image.height - 1));
    writer.begin_segment(y, x0);
    int x = x0;
    for (; x + block <= x1; x += block) {
      __builtin_prefetch(ahead + x);
      if (!writer.add(x, block_mask(row + x, threshold))) return false;
    }
    if (x < x1) {
      __builtin_prefetch(ahead + x);
      if (!writer.add(x, bright_mask(row, image.width, x, x1, threshold))) return false;
    }
    writer.end_segment(x1);
    return true;
  };
  work.stretches = for_each_row_segment(image, rois, limits, band, scan);
  return work;
}

}  // namespace

ThresholdWork threshold_runs(const Frame& frame, const Rois& rois, std::uint16_t threshold,
                             RowBand band, Runs& out, const Limits& limits) noexcept {
  RunWriter writer(out, limits.runs_per_band);
  ThresholdWork work;
  if (!is_valid_input(frame, band, limits)) return work;
  if (!frame.reflectivity_16.empty()) {
    work = scan_fast(frame.reflectivity_16, rois, limits, threshold, band, writer);
  } else if (!frame.reflectivity_8.empty() && threshold < 0xFF) {
    const auto narrow = static_cast<std::uint8_t>(threshold);
    work = scan_fast(frame.reflectivity_8, rois, limits, narrow, band, writer);
  }
  writer.finish();
  work.runs = out.count;
  return work;
}

}  // namespace glint
