#include "platform/sinks/record/frame_patch.hpp"

#include <algorithm>
#include <cstring>
#include <vector>

namespace glint {
namespace {

std::size_t area(const Roi& roi) noexcept {
  return static_cast<std::size_t>(roi.x1 - roi.x0) * static_cast<std::size_t>(roi.y1 - roi.y0);
}

FrameLayout without_rectangles(const Frame& frame) noexcept {
  constexpr int k_size_max = 65535;
  FrameLayout layout;
  layout.mid_exposure = frame.mid_exposure;
  layout.stamp_sigma = frame.stamp_sigma;
  layout.arrival = frame.arrival;
  layout.sequence = frame.sequence;
  const int width = frame.width();
  const int height = frame.height();
  const bool sized = width > 0 && height > 0 && width <= k_size_max && height <= k_size_max;
  if (!sized) return layout;
  layout.width = static_cast<std::uint16_t>(width);
  layout.height = static_cast<std::uint16_t>(height);
  if (!frame.reflectivity_8.empty()) layout.reflectivity_bits = 8;
  if (!frame.reflectivity_16.empty()) layout.reflectivity_bits = 16;
  layout.has_depth =
      !frame.depth.empty() && frame.depth.width == width && frame.depth.height == height;
  return layout;
}

template <class Pixel>
std::uint8_t* copy_rows(const ImageView<Pixel>& image, const Roi& roi, std::uint8_t* to) noexcept {
  const std::size_t row_bytes = static_cast<std::size_t>(roi.x1 - roi.x0) * sizeof(Pixel);
  for (int y = roi.y0; y < roi.y1; ++y, to += row_bytes)
    std::memcpy(to, image.row(y) + roi.x0, row_bytes);
  return to;
}

// Returns false if the size of the rows is not that of the rectangle.
template <class Pixel>
bool put_rows(std::span<const std::uint8_t> rows, const Roi& roi, int frame_width,
              std::vector<Pixel>& frame) {
  const auto row_bytes = static_cast<std::size_t>(roi.x1 - roi.x0) * sizeof(Pixel);
  if (rows.size() != row_bytes * static_cast<std::size_t>(roi.y1 - roi.y0)) return false;
  if (row_bytes == 0) return true;
  const std::uint8_t* from = rows.data();
  for (int y = roi.y0; y < roi.y1; ++y, from += row_bytes)
    std::memcpy(frame.data() + static_cast<std::ptrdiff_t>(y) * frame_width + roi.x0, from,
                row_bytes);
  return true;
}

}  // namespace

std::size_t reflectivity_bytes(const FrameLayout& layout, const Roi& roi) noexcept {
  return area(roi) * (layout.reflectivity_bits / 8U);
}

std::size_t depth_bytes(const FrameLayout& layout, const Roi& roi) noexcept {
  return layout.has_depth ? area(roi) * 2 : 0;
}

std::size_t pixel_bytes(const FrameLayout& layout) noexcept {
  std::size_t bytes = 0;
  for (int i = 0; i < layout.rectangle_count; ++i) {
    const Roi& roi = layout.rectangles[static_cast<std::size_t>(i)];
    bytes += reflectivity_bytes(layout, roi) + depth_bytes(layout, roi);
  }
  return bytes;
}

FrameLayout whole_frame_layout(const Frame& frame) noexcept {
  FrameLayout layout = without_rectangles(frame);
  if (layout.width == 0) return layout;
  layout.rectangles[0] = {0, 0, layout.width, layout.height};
  layout.rectangle_count = 1;
  return layout;
}

FrameLayout roi_layout(const Frame& frame, const Rois& rois, int margin_px) noexcept {
  FrameLayout layout = without_rectangles(frame);
  std::size_t kept = 0;
  const int count = std::clamp(rois.count, 0, k_patch_rectangles_max);
  for (int i = 0; i < count; ++i) {
    const Roi& roi = rois.items[static_cast<std::size_t>(i)];
    if (roi.x1 <= roi.x0 || roi.y1 <= roi.y0) continue;
    const Roi grown{std::clamp(roi.x0 - margin_px, 0, int{layout.width}),
                    std::clamp(roi.y0 - margin_px, 0, int{layout.height}),
                    std::clamp(roi.x1 + margin_px, 0, int{layout.width}),
                    std::clamp(roi.y1 + margin_px, 0, int{layout.height})};
    if (grown.x1 <= grown.x0 || grown.y1 <= grown.y0) continue;
    layout.rectangles[static_cast<std::size_t>(layout.rectangle_count++)] = grown;
    kept += area(grown);
  }
  const std::size_t whole = static_cast<std::size_t>(layout.width) * layout.height;
  return kept >= whole ? whole_frame_layout(frame) : layout;
}

void copy_pixels(const Frame& frame, const FrameLayout& layout,
                 std::span<std::uint8_t> pixels) noexcept {
  std::uint8_t* to = pixels.data();
  for (int i = 0; i < layout.rectangle_count; ++i) {
    const Roi& roi = layout.rectangles[static_cast<std::size_t>(i)];
    if (layout.reflectivity_bits == 8) to = copy_rows(frame.reflectivity_8, roi, to);
    if (layout.reflectivity_bits == 16) to = copy_rows(frame.reflectivity_16, roi, to);
    if (layout.has_depth) to = copy_rows(frame.depth, roi, to);
  }
}

FrameBuffer empty_frame(const FrameLayout& layout) {
  const auto pixels = static_cast<std::size_t>(layout.width) * layout.height;
  FrameBuffer frame;
  frame.width = layout.width;
  frame.height = layout.height;
  if (layout.reflectivity_bits == 8) frame.reflectivity_8.resize(pixels);
  if (layout.reflectivity_bits == 16) frame.reflectivity_16.resize(pixels);
  if (layout.has_depth) frame.depth.resize(pixels);
  return frame;
}

bool put_rectangle(std::span<const std::uint8_t> reflectivity, std::span<const std::uint8_t> depth,
                   const Roi& roi, const FrameLayout& layout, FrameBuffer& frame) {
  if (roi.x1 > layout.width || roi.y1 > layout.height) return false;
  const bool reflectivity_fits =
      layout.reflectivity_bits == 8
          ? put_rows(reflectivity, roi, layout.width, frame.reflectivity_8)
      : layout.reflectivity_bits == 16
          ? put_rows(reflectivity, roi, layout.width, frame.reflectivity_16)
          : reflectivity.empty();
  return reflectivity_fits &&
         (layout.has_depth ? put_rows(depth, roi, layout.width, frame.depth) : depth.empty());
}

FrameBuffer frame_of(const FramePatch& patch) {
  const FrameLayout& layout = patch.layout;
  FrameBuffer frame = empty_frame(layout);
  std::size_t at = 0;
  for (int i = 0; i < layout.rectangle_count; ++i) {
    const Roi& roi = layout.rectangles[static_cast<std::size_t>(i)];
    const std::size_t reflectivity = reflectivity_bytes(layout, roi);
    const std::size_t depth = depth_bytes(layout, roi);
    (void)put_rectangle(patch.pixels.subspan(at, reflectivity),
                        patch.pixels.subspan(at + reflectivity, depth), roi, layout, frame);
    at += reflectivity + depth;
  }
  return frame;
}

}  // namespace glint
