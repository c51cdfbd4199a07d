#include <cstddef>
#include <cstring>
#include <span>
#include <vector>

#include "kernels/limits.hpp"
#include "platform/sinks/record/glint_messages.hpp"
#include "platform/sinks/record/message_parts.hpp"

namespace glint {
namespace {

// Copies one rectangle's rows into the frame; returns false if their size does not match it.
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

// Largest camera image: bounds the memory that a short message can request.
constexpr std::size_t k_pixels_max = std::size_t{k_width_max} * k_height_max;

struct FrameShape {
  int width = 0, height = 0, reflectivity_bits = 0;
  bool has_depth = false;
};

bool put_rectangle(std::span<const std::uint8_t> reflectivity, std::span<const std::uint8_t> depth,
                   const Roi& roi, const FrameShape& shape, FrameBuffer& frame) {
  if (roi.x1 > shape.width || roi.y1 > shape.height) return false;
  const bool reflectivity_fits =
      shape.reflectivity_bits == 8 ? put_rows(reflectivity, roi, shape.width, frame.reflectivity_8)
      : shape.reflectivity_bits == 16
          ? put_rows(reflectivity, roi, shape.width, frame.reflectivity_16)
          : reflectivity.empty();
  return reflectivity_fits &&
         (shape.has_depth ? put_rows(depth, roi, shape.width, frame.depth) : depth.empty());
}

}  // namespace

std::optional<FrameMessage> read_frame(MessageBytes bytes, const ImageRows& reflectivity,
                                       const ImageRows& depth) {
  CdrReader from(bytes);
  FrameMessage frame;
  skip_header(from);
  get_stamps(from, frame);
  FrameShape shape;
  shape.width = from.get<std::uint16_t>();
  shape.height = from.get<std::uint16_t>();
  shape.reflectivity_bits = from.get<std::uint8_t>();
  shape.has_depth = from.get<bool>();
  const bool in_images = from.get<bool>();
  const auto count = from.get<std::uint32_t>();
  if (from.failed() || count > k_patch_rectangles_max) return std::nullopt;
  const auto pixels =
      static_cast<std::size_t>(shape.width) * static_cast<std::size_t>(shape.height);
  if (pixels > k_pixels_max) return std::nullopt;
  frame.pixels.width = shape.width;
  frame.pixels.height = shape.height;
  if (shape.reflectivity_bits == 8) frame.pixels.reflectivity_8.resize(pixels);
  if (shape.reflectivity_bits == 16) frame.pixels.reflectivity_16.resize(pixels);
  if (shape.has_depth) frame.pixels.depth.resize(pixels);
  for (std::uint32_t i = 0; i < count; ++i) {
    Roi roi;
    roi.x0 = from.get<std::uint16_t>();
    roi.y0 = from.get<std::uint16_t>();
    roi.x1 = roi.x0 + from.get<std::uint16_t>();
    roi.y1 = roi.y0 + from.get<std::uint16_t>();
    const auto reflectivity_rows = from.get_bytes();
    const auto depth_rows = from.get_bytes();
    if (from.failed() || !put_rectangle(reflectivity_rows, depth_rows, roi, shape, frame.pixels))
      return std::nullopt;
  }
  if (!from.at_end()) frame.stamp_sigma.nanoseconds = from.get<std::int64_t>();  // none: older
  if (from.failed()) return std::nullopt;
  if (in_images) {
    const Roi all{0, 0, shape.width, shape.height};
    const auto depth_rows =
        shape.has_depth ? std::span(depth.rows) : std::span<const std::uint8_t>();
    if (!put_rectangle(reflectivity.rows, depth_rows, all, shape, frame.pixels))
      return std::nullopt;
  }
  return frame;
}

std::optional<ImageRows> read_image(MessageBytes bytes) {
  CdrReader from(bytes);
  ImageRows image;
  skip_header(from);
  image.height = from.get<std::uint32_t>();
  image.width = from.get<std::uint32_t>();
  (void)from.get_text();
  (void)from.get<std::uint8_t>();
  image.step = from.get<std::uint32_t>();
  const auto rows = from.get_bytes();
  if (from.failed() || rows.size() != std::uint64_t{image.step} * image.height) return std::nullopt;
  image.rows.assign(rows.begin(), rows.end());
  return image;
}

}  // namespace glint
