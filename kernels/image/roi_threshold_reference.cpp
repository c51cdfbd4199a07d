// Reference implementation of roi_threshold.cpp: pixel by pixel, without shared code.
#include "kernels/image/roi_threshold.hpp"

namespace glint {
namespace {

// More ROIs than tools mean the whole frame.
bool in_any_roi(const Rois& rois, const Limits& limits, int x, int y) {
  const int tools = limits.tools < 1 ? 1 : limits.tools > k_tools_max ? k_tools_max : limits.tools;
  if (rois.count > tools) return true;
  for (int i = 0; i < rois.count; ++i) {
    const Roi& roi = rois.items[static_cast<std::size_t>(i)];
    if (roi.x0 <= x && x < roi.x1 && roi.y0 <= y && y < roi.y1) return true;
  }
  return false;
}

}  // namespace

void threshold_runs_reference(const Frame& frame, const Rois& rois, std::uint16_t threshold,
                              RowBand band, Runs& out, const Limits& limits) noexcept {
  out.count = 0;
  out.reason = Reason::none;
  const bool wide = !frame.reflectivity_16.empty();
  if (band.count < 1 || band.index < 0 || band.index >= band.count) return;
  if (frame.width() > limits.width || frame.width() > k_width_max) return;
  if (frame.height() > limits.height || frame.height() > k_height_max) return;
  if (wide && limits.reflectivity_bytes < 2) return;
  if (!wide && (frame.reflectivity_8.empty() || limits.reflectivity_bytes < 1)) return;
  const int end = frame.height() * (band.index + 1) / band.count;
  for (int y = frame.height() * band.index / band.count; y < end; ++y) {
    bool open = false;
    for (int x = 0; x < frame.width(); ++x) {
      const int value = wide ? frame.reflectivity_16.row(y)[x] : frame.reflectivity_8.row(y)[x];
      const bool bright = value > threshold && in_any_roi(rois, limits, x, y);
      if (bright && !open &&
          (out.count >= limits.runs_per_band || out.count >= k_runs_per_band_max)) {
        out.reason = Reason::runs_full;
        return;
      }
      if (bright && !open) {
        out.items[static_cast<std::size_t>(out.count++)] = {static_cast<std::uint16_t>(y),
                                                            static_cast<std::uint16_t>(x), 0};
      }
      open = bright;
      if (open)
        out.items[static_cast<std::size_t>(out.count - 1)].x1 = static_cast<std::uint16_t>(x + 1);
    }
  }
}

}  // namespace glint
