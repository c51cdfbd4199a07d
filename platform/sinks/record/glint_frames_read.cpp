#include <cstddef>
#include <span>

#include "kernels/limits.hpp"
#include "platform/sinks/record/glint_messages.hpp"
#include "platform/sinks/record/message_parts.hpp"

namespace glint {
namespace {

// Largest camera image: bounds the memory that a short message can request.
constexpr std::size_t k_pixels_max = std::size_t{k_width_max} * k_height_max;

}  // namespace

std::optional<FrameMessage> read_frame(MessageBytes bytes, const ImageRows& reflectivity,
                                       const ImageRows& depth) {
  CdrReader from(bytes);
  FrameMessage frame;
  skip_header(from);
  get_stamps(from, frame);
  FrameLayout shape;
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
  frame.pixels = empty_frame(shape);
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
