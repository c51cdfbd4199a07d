#include "kernels/image/roi_threshold.hpp"

#include <algorithm>
#include <cstddef>

#include "kernels/image/bright_mask.hpp"
#include "kernels/image/run_writer.hpp"

namespace glint {
namespace {

// The ROIs clipped to the frame's rows of this band, from left to right: a total order.
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

// Calls scan(pixels of the row, y, x0, x1) for each stretch of a row that lies in an ROI; gives the
// number of ROIs times rows.
template <class Pixel, class Scan>
int for_each_stretch(const ImageView<Pixel>& image, const Rois& rois, const Limits& limits,
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
      if (x0 < roi.x1) scan(image.row(y), y, x0, roi.x1);
      end = std::max(end, roi.x1);
    }
  }
  return (bottom - top) * cut.count;
}

bool usable(const Frame& frame, RowBand band, const Limits& limits) {
  const int bytes = frame.reflectivity_16.empty() ? 1 : 2;
  return band.count > 0 && band.index >= 0 && band.index < band.count &&
         frame.width() <= std::min(limits.width, k_width_max) &&
         frame.height() <= std::min(limits.height, k_height_max) &&
         bytes <= limits.reflectivity_bytes;
}

// A narrow ROI jumps from row to row too fast for the processor to foresee: its rows are asked for
// this many ahead, which takes the memory's time off a frame that no cache holds yet.
constexpr int k_rows_ahead = 12;
constexpr std::ptrdiff_t k_cache_line_bytes = 64;

template <class Pixel>
void ask_for(const ImageView<Pixel>& image, int x0, int x1, int y) {
  if (y >= image.height) return;
  const auto* from = reinterpret_cast<const std::uint8_t*>(image.row(y) + x0);
  const auto* to = reinterpret_cast<const std::uint8_t*>(image.row(y) + x1);
  for (; from < to; from += k_cache_line_bytes) __builtin_prefetch(from);
}

template <class Pixel>
ThresholdWork scan_fast(const ImageView<Pixel>& image, const Rois& rois, const Limits& limits,
                        Pixel threshold, RowBand band, RunWriter& writer) {
  constexpr int block = k_mask_pixels<Pixel>;
  ThresholdWork work;
  const auto scan = [&](const Pixel* row, int y, int x0, int x1) {
    const int blocks = (x1 - x0 + block - 1) / block;
    work.blocks += blocks;
    if (x1 - x0 < image.width) ask_for(image, x0, x1, y + k_rows_ahead);
    if (!any_above(row, image.width, x0, x1, threshold)) return;
    work.masks += blocks;
    for (int x = x0; x < x1; x += block) {
      writer.add(y, x, bright_mask(row, image.width, x, x1, threshold));
    }
  };
  work.stretches = for_each_stretch(image, rois, limits, band, scan);
  return work;
}

template <class Pixel>
void scan_reference(const ImageView<Pixel>& image, const Rois& rois, const Limits& limits,
                    std::uint16_t threshold, RowBand band, RunWriter& writer) {
  for_each_stretch(image, rois, limits, band, [&](const Pixel* row, int y, int x0, int x1) {
    for (int x = x0; x < x1; ++x) writer.add(y, x, row[x] > threshold ? 1 : 0);
  });
}

}  // namespace

ThresholdWork threshold_runs(const Frame& frame, const Rois& rois, std::uint16_t threshold,
                             RowBand band, Runs& out, const Limits& limits) noexcept {
  RunWriter writer(out, limits.runs_per_band);
  ThresholdWork work;
  if (!usable(frame, band, limits)) return work;
  if (!frame.reflectivity_16.empty()) {
    work = scan_fast(frame.reflectivity_16, rois, limits, threshold, band, writer);
  } else if (!frame.reflectivity_8.empty() && threshold < 0xFF) {
    const auto narrow = static_cast<std::uint8_t>(threshold);
    work = scan_fast(frame.reflectivity_8, rois, limits, narrow, band, writer);
  }
  work.runs = out.count;
  return work;
}

void threshold_runs_reference(const Frame& frame, const Rois& rois, std::uint16_t threshold,
                              RowBand band, Runs& out, const Limits& limits) noexcept {
  RunWriter writer(out, limits.runs_per_band);
  if (!usable(frame, band, limits)) return;
  if (!frame.reflectivity_16.empty()) {
    scan_reference(frame.reflectivity_16, rois, limits, threshold, band, writer);
  } else if (!frame.reflectivity_8.empty()) {
    scan_reference(frame.reflectivity_8, rois, limits, threshold, band, writer);
  }
}

}  // namespace glint
