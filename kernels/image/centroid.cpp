#include "kernels/image/centroid.hpp"

#include <algorithm>
#include <array>

#include "kernels/image/bright_mask.hpp"

namespace glint {
namespace {

struct Sums {
  std::int64_t weight = 0, x = 0, y = 0;  // in half pixels: a centre is at 2 x + 1
  std::int64_t pixels = 0, pixels_x = 0, pixels_y = 0;
};

Vector2 from_half_pixels(std::int64_t x, std::int64_t y, std::int64_t weight) {
  const auto w = static_cast<double>(weight);
  return {static_cast<double>(x) / w * 0.5, static_cast<double>(y) / w * 0.5};
}

// Calls visit(run) for each of the component's runs, at most k_runs_max.
template <class Visit>
void for_each_run(const BlobScratch& scratch, const Component& component, Visit visit) {
  std::uint16_t index = component.first_run;
  for (int i = 0; i < k_runs_max; ++i) {
    visit(scratch.runs[index]);
    if (index == component.last_run) return;
    index = scratch.next_run[index];
  }
}

template <class Pixel>
Centroid above_threshold(const ImageView<Pixel>& image, const BlobScratch& scratch,
                         const Component& component, std::int64_t threshold, bool weighted) {
  Sums sums;
  Pixel peak = 0;
  for_each_run(scratch, component, [&](const Run& run) {
    const Pixel* row = image.row(run.y);
    for (int x = run.x0; x < run.x1; ++x) {
      peak = std::max(peak, row[x]);
      const std::int64_t weight = weighted ? row[x] - threshold : 1;
      sums.weight += weight;
      sums.x += weight * (2 * x + 1);
      sums.y += weight * (2 * run.y + 1);
    }
  });
  if (sums.weight <= 0) return {};
  return {from_half_pixels(sums.x, sums.y, sums.weight), peak};
}

// Row masks of the component with a margin of two all round; bit 0 is column x0 - 2.
using Mask = std::array<std::uint64_t, k_grown_box_max + 4>;

constexpr std::uint64_t widened(std::uint64_t row) { return row | row << 1 | row >> 1; }

void grow(const Mask& mask, int rows, Mask& out) {
  for (int y = 0; y < rows; ++y) {
    const auto at = static_cast<std::size_t>(y);
    std::uint64_t row = mask[at];
    if (y > 0) row |= mask[at - 1];
    if (y + 1 < rows) row |= mask[at + 1];
    out[at] = widened(row);
  }
}

// Adds the pixels of one row where bits are set.
template <class Pixel>
void add_row(const Pixel* row, int left, int y, std::uint64_t bits, Sums& sums) {
  for_each_bit_run(bits, [&](int from, int to) {
    std::int64_t weight = 0, x_sum = 0;
    for (int bit = from; bit < to; ++bit) {
      weight += row[left + bit];
      x_sum += static_cast<std::int64_t>(row[left + bit]) * (2 * (left + bit) + 1);
    }
    const std::int64_t n = to - from;
    sums.weight += weight;
    sums.x += x_sum;
    sums.y += weight * (2 * y + 1);
    sums.pixels += n;
    sums.pixels_x += n * (2 * left + from + to);  // sum of 2 (left + bit) + 1
    sums.pixels_y += n * (2 * y + 1);
  });
}

template <class Pixel>
Centroid grown(const ImageView<Pixel>& image, const BlobScratch& scratch,
               const Component& component, std::uint16_t threshold) {
  const int left = component.x0 - 2, top = component.y0 - 2;
  const int rows = component.y1 - component.y0 + 4;
  Mask own, one, two;
  std::fill_n(own.begin(), rows, 0);
  Pixel peak = 0;
  for_each_run(scratch, component, [&](const Run& run) {
    const std::uint64_t ones = (std::uint64_t{1} << (run.x1 - run.x0)) - 1;
    own[static_cast<std::size_t>(run.y - top)] |= ones << (run.x0 - left);
    const Pixel* row = image.row(run.y);
    for (int x = run.x0; x < run.x1; ++x) peak = std::max(peak, row[x]);
  });
  grow(own, rows, one);
  grow(one, rows, two);
  // Columns outside the frame.
  const int columns = component.x1 - component.x0 + 4;
  std::uint64_t in_frame = columns == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << columns) - 1;
  if (left < 0) in_frame &= ~std::uint64_t{0} << -left;
  if (left + columns > image.width) in_frame &= ~std::uint64_t{0} >> (64 - (image.width - left));

  Sums sums;
  std::int64_t dark = 0, dark_pixels = 0;
  for (int i = 0; i < rows; ++i) {
    const int y = top + i;
    if (y < 0 || y >= image.height) continue;
    const auto at = static_cast<std::size_t>(i);
    const Pixel* row = image.row(y);
    add_row(row, left, y, one[at] & in_frame, sums);
    for_each_bit_run(two[at] & ~one[at] & in_frame, [&](int from, int to) {
      for (int bit = from; bit < to; ++bit) {
        const Pixel value = row[left + bit];
        if (value > threshold) continue;  // belongs to a neighbour
        dark += value;
        ++dark_pixels;
      }
    });
  }
  // (I - dark / dark_pixels), times dark_pixels: at most 65535 * 64^2 * 64^2 * 1024 < 2^51.
  const std::int64_t n = std::max<std::int64_t>(dark_pixels, 1);
  const std::int64_t weight = sums.weight * n - dark * sums.pixels;
  const Vector2 position =
      from_half_pixels(sums.x * n - dark * sums.pixels_x, sums.y * n - dark * sums.pixels_y,
                       std::max<std::int64_t>(weight, 1));
  const bool inside = position.x() >= component.x0 && position.x() <= component.x1 &&
                      position.y() >= component.y0 && position.y() <= component.y1;
  if (weight <= 0 || !inside) return above_threshold(image, scratch, component, 0, false);
  return {position, peak};
}

}  // namespace

Centroid grown_centroid(const Frame& frame, const BlobScratch& scratch, const Component& component,
                        std::uint16_t threshold) noexcept {
  if (component.x1 - component.x0 > k_grown_box_max ||
      component.y1 - component.y0 > k_grown_box_max) {
    return binary_centroid(frame, scratch, component);
  }
  return frame.reflectivity_8.empty() ? grown(frame.reflectivity_16, scratch, component, threshold)
                                      : grown(frame.reflectivity_8, scratch, component, threshold);
}

Centroid weighted_centroid(const Frame& frame, const BlobScratch& scratch,
                           const Component& component, std::uint16_t threshold) noexcept {
  return frame.reflectivity_8.empty()
             ? above_threshold(frame.reflectivity_16, scratch, component, threshold, true)
             : above_threshold(frame.reflectivity_8, scratch, component, threshold, true);
}

Centroid binary_centroid(const Frame& frame, const BlobScratch& scratch,
                         const Component& component) noexcept {
  return frame.reflectivity_8.empty()
             ? above_threshold(frame.reflectivity_16, scratch, component, 0, false)
             : above_threshold(frame.reflectivity_8, scratch, component, 0, false);
}

}  // namespace glint
