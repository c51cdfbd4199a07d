// Recorded part of a frame's pixels: several rectangles, or the whole frame as one.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "kernels/image/frame.hpp"
#include "kernels/image/roi.hpp"
#include "kernels/units.hpp"
#include "platform/formats/frame_buffer.hpp"

namespace glint {

inline constexpr int k_patch_rectangles_max = k_tools_max;

// Metadata of a frame and its recorded rectangles.
struct FrameLayout {
  Time mid_exposure;
  Duration stamp_sigma;
  Time arrival;
  std::uint64_t sequence = 0;
  std::uint16_t width = 0;
  std::uint16_t height = 0;
  std::uint8_t reflectivity_bits = 0;                    // 8 or 16; 0: the frame has no such plane
  bool has_depth = false;                                // a depth plane of the same size
  std::array<Roi, k_patch_rectangles_max> rectangles{};  // inside the frame; they may overlap
  int rectangle_count = 0;
};

// `pixels` holds, per rectangle, the rows of reflectivity and then the rows of depth, in the byte
// order of the machine (little endian wherever Glint runs).
struct FramePatch {
  FrameLayout layout;
  std::span<const std::uint8_t> pixels;
};

// Number of pixel bytes of a layout, and of one of its rectangles.
[[nodiscard]] std::size_t pixel_bytes(const FrameLayout& layout) noexcept;
[[nodiscard]] std::size_t reflectivity_bytes(const FrameLayout& layout, const Roi& roi) noexcept;
[[nodiscard]] std::size_t depth_bytes(const FrameLayout& layout, const Roi& roi) noexcept;

// The whole frame as one rectangle; no rectangle if the frame has no pixels.
[[nodiscard]] FrameLayout whole_frame_layout(const Frame& frame) noexcept;

// The regions, each enlarged by margin_px and clipped to the frame. If they cover as many pixels as
// the frame, the whole frame is kept. Kernels that read beyond their region (depth annulus,
// centroid) need equal pixels there in a replay: hence the margin.
[[nodiscard]] FrameLayout roi_layout(const Frame& frame, const Rois& rois, int margin_px) noexcept;

// Copies the layout's pixels from its frame. Requires pixels.size() == pixel_bytes(layout).
// Cost: one copy of that many bytes; no allocation.
void copy_pixels(const Frame& frame, const FrameLayout& layout,
                 std::span<std::uint8_t> pixels) noexcept;

// A frame of the layout's size and planes; every pixel is 0.
[[nodiscard]] FrameBuffer empty_frame(const FrameLayout& layout);

// Copies a rectangle's rows into such a frame. Returns false if a plane's rows do not have the
// rectangle's size or the rectangle is not inside the frame.
[[nodiscard]] bool put_rectangle(std::span<const std::uint8_t> reflectivity,
                                 std::span<const std::uint8_t> depth, const Roi& roi,
                                 const FrameLayout& layout, FrameBuffer& frame);

// The patch as a frame; pixels outside its rectangles are 0. Requires pixels of its layout.
[[nodiscard]] FrameBuffer frame_of(const FramePatch& patch);

}  // namespace glint
