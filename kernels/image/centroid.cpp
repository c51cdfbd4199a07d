#include "kernels/image/centroid.hpp"

#include <algorithm>
#include <array>

#include "kernels/image/box_sums.hpp"

namespace glint {
namespace {

Vector2 from_half_pixels(std::int64_t x, std::int64_t y, std::int64_t weight) {
  const auto w = static_cast<double>(weight);
  return {static_cast<double>(x) / w * 0.5, static_cast<double>(y) / w * 0.5};
}

template <class Pixel>
Centroid weighted(const ImageView<Pixel>& image, const BlobScratch& scratch,
                  const Component& component, std::int64_t threshold) {
  std::int64_t weights = 0, x_sum = 0, y_sum = 0;  // sums in half pixels: a centre is at 2 x + 1
  Pixel peak = 0;
  for_each_run(scratch, component, [&](const RasterRun& run) {
    const Pixel* row = image.row(run.y());
    for (int x = run.x0(); x < run.x1(); ++x) {
      peak = std::max(peak, row[x]);
      const std::int64_t weight = row[x] - threshold;
      weights += weight;
      x_sum += weight * (2 * x + 1);
      y_sum += weight * (2 * run.y() + 1);
    }
  });
  if (weights <= 0) return {};
  Centroid out;
  out.position_px = from_half_pixels(x_sum, y_sum, weights);
  out.peak = peak;
  return out;
}

template <class Pixel>
Centroid binary(const ImageView<Pixel>& image, const BlobScratch& scratch,
                const Component& component) {
  std::int64_t pixels = 0, x_sum = 0, y_sum = 0;
  Pixel peak = 0;
  for_each_run(scratch, component, [&](const RasterRun& run) {
    const int x0 = run.x0(), x1 = run.x1();
    const std::int64_t length = x1 - x0;
    const Pixel* row = image.row(run.y());
    peak = std::max({peak, row[x0], row[(x0 + x1) / 2], row[x1 - 1]});
    pixels += length;
    x_sum += length * (x0 + x1);  // the sum of 2 x + 1
    y_sum += length * (2 * run.y() + 1);
  });
  Centroid out;
  out.position_px = from_half_pixels(x_sum, y_sum, pixels);
  out.peak = peak;
  return out;
}

// plain(): the plain mean, used if the blob is not brighter than its surroundings.
template <class Plain>
Centroid from_sums(const GrownSums& total, const Component& component, Plain plain) {
  // Sums of (I - dark / dark_pixels), times dark_pixels: at most 65535 * 64^2 * 64^2 * 2048 < 2^52.
  const std::int64_t n = std::max<std::int64_t>(total.dark_pixels, 1);
  const std::int64_t weight = total.weight * n - total.dark * total.pixels;
  Centroid out;
  out.position_px = from_half_pixels(total.x * n - total.dark * total.pixels_x,
                                     total.y * n - total.dark * total.pixels_y,
                                     std::max<std::int64_t>(weight, 1));
  out.peak = total.peak;
  out.has_bright_rim = total.bright_rim;
  const double x = out.position_px.x(), y = out.position_px.y();
  const bool inside =
      x >= component.x0 && x <= component.x1 && y >= component.y0 && y <= component.y1;
  if (weight <= 0 || !inside) {
    out.position_px = plain().position_px;
    return out;
  }
  const auto pixels = static_cast<double>(total.pixels), dark_pixels = static_cast<double>(n);
  out.intensity_sum = static_cast<double>(weight) / dark_pixels;
  out.background = static_cast<double>(total.dark) / dark_pixels;
  out.pixels = static_cast<std::int32_t>(total.pixels);
  out.dark_pixels = static_cast<std::int32_t>(n);
  out.lever_px = {0.5 * static_cast<double>(total.pixels_x) - pixels * x,
                  0.5 * static_cast<double>(total.pixels_y) - pixels * y};
  return out;
}

constexpr std::uint64_t widened(std::uint64_t row) { return row | row << 1 | row >> 1; }

template <class Pixel>
Centroid grown(const ImageView<Pixel>& image, const Frame& frame, const BlobScratch& scratch,
               const Component& component, std::uint16_t threshold) {
  const GrownBox box = grown_box(frame, component);
  // The blob's row masks, with two empty rows above and below and two more to read ahead.
  std::array<std::uint64_t, k_grown_box_max + 6> own;
  const int top = component.y0 - 2, rows = component.y1 - component.y0;
  std::fill_n(own.begin(), rows + 6, 0);
  for_each_run(scratch, component, [&](const RasterRun& run) {
    const std::uint64_t ones = (std::uint64_t{1} << (run.x1() - run.x0())) - 1;
    own[static_cast<std::size_t>(run.y() - top)] |= ones << (run.x0() - box.left);
  });
  const int columns = image.width - box.left;
  const std::uint64_t in_frame =
      columns < 64 ? (std::uint64_t{1} << columns) - 1 : ~std::uint64_t{0};

  // Masks grown by one pixel: of the previous row, this row and the next row.
  std::uint64_t before = 0, near = 0, after = 0;
  BoxSums sums(box, threshold);
  for (int y = top; y < box.bottom; ++y) {
    const auto at = static_cast<std::size_t>(y - top);
    before = near;
    near = after;
    after = widened(own[at] | own[at + 1] | own[at + 2]);
    if (y < box.top) continue;
    const std::uint64_t rim = widened(before | near | after);
    sums.add_row(image.row(y) + box.left, columns, {near & in_frame, rim & in_frame & ~near});
  }
  return from_sums(sums.total(), component, [&] { return binary(image, scratch, component); });
}

}  // namespace

Centroid grown_centroid(const Frame& frame, const BlobScratch& scratch, const Component& component,
                        std::uint16_t threshold) noexcept {
  if (!fits_grown_box(component)) return binary_centroid(frame, scratch, component);
  return frame.reflectivity_8.empty()
             ? grown(frame.reflectivity_16, frame, scratch, component, threshold)
             : grown(frame.reflectivity_8, frame, scratch, component, threshold);
}

Centroid weighted_centroid(const Frame& frame, const BlobScratch& scratch,
                           const Component& component, std::uint16_t threshold) noexcept {
  return frame.reflectivity_8.empty()
             ? weighted(frame.reflectivity_16, scratch, component, threshold)
             : weighted(frame.reflectivity_8, scratch, component, threshold);
}

Centroid binary_centroid(const Frame& frame, const BlobScratch& scratch,
                         const Component& component) noexcept {
  return frame.reflectivity_8.empty() ? binary(frame.reflectivity_16, scratch, component)
                                      : binary(frame.reflectivity_8, scratch, component);
}

}  // namespace glint
