// The pixels of a frame that are worth keeping: rectangles of it, or all of it as one.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "kernels/image/frame.hpp"
#include "kernels/image/roi.hpp"
#include "kernels/units.hpp"

namespace glint {

inline constexpr int k_patch_rectangles_max = k_tools_max;

// Everything of a frame but its pixels.
struct FrameLayout {
  Time mid_exposure;
  Duration stamp_sigma;
  Time arrival;
  std::uint64_t sequence = 0;
  std::uint16_t width = 0;
  std::uint16_t height = 0;
  std::uint8_t reflectivity_bits = 0;  // 8 or 16; 0: the frame came without that plane
  bool has_depth = false;              // a depth plane of the same size
  std::array<Roi, k_patch_rectangles_max> rectangles{};  // inside the frame; they may overlap
  int rectangle_count = 0;
};

// `pixels` holds, rectangle by rectangle, its rows of reflectivity and then its rows of depth, in
// the byte order of the machine (little endian wherever Glint runs).
struct FramePatch {
  FrameLayout layout;
  std::span<const std::uint8_t> pixels;
};

// The bytes of pixels that a layout asks for; of one rectangle of it.
[[nodiscard]] std::size_t pixel_bytes(const FrameLayout& layout) noexcept;
[[nodiscard]] std::size_t reflectivity_bytes(const FrameLayout& layout, const Roi& roi) noexcept;
[[nodiscard]] std::size_t depth_bytes(const FrameLayout& layout, const Roi& roi) noexcept;

// The whole frame as one rectangle; no rectangle where the frame has no pixels.
[[nodiscard]] FrameLayout whole_frame_layout(const Frame& frame) noexcept;

// The regions, each grown by margin_px and cut at the border. As soon as they hold as many pixels
// as the frame, it is kept whole. A kernel that looks beyond its region (ring depth, centroid) must
// find the same there in a replay: that is what the margin is for.
[[nodiscard]] FrameLayout roi_layout(const Frame& frame, const Rois& rois, int margin_px) noexcept;

// Copies the layout's pixels out of the frame it was made of. pixels.size() == pixel_bytes(layout).
// Cost: one copy of that many bytes; no allocation.
void copy_pixels(const Frame& frame, const FrameLayout& layout,
                 std::span<std::uint8_t> pixels) noexcept;

}  // namespace glint
