// Image moments for a grown centroid: SIMD sums over a masked box, eight columns at a time.
//
// What:     reflectivity, positions and number of the pixels near the blob; reflectivity and number
//           of the dark pixels around them, and whether one there is bright; the brightest pixel.
// Cost:     the same for each eight columns of a row, for any mask, and about as much again for
//           each row.
// Worst:    data independent.
// Accuracy: exact: lanes of 16 and 32 bits that cannot overflow, see k_rows_max.
// Source:   subtracting 2^15 makes reflectivities signed, as the pairwise product requires; total()
//           adds it again for each pixel. Row moments: a sum of partial sums counts each row once
//           for itself and once for every later row.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "kernels/image/grown_box.hpp"
#include "kernels/image/pair_products.hpp"

namespace glint {

struct GrownSums {
  std::int64_t weight = 0, x = 0, y = 0;  // x, y in half pixels: a pixel centre is at 2 x + 1
  std::int64_t pixels = 0, pixels_x = 0, pixels_y = 0;
  std::int64_t dark = 0, dark_pixels = 0;
  std::uint16_t peak = 0;
  bool bright_rim = false;  // a neighbour is one pixel further, or the ROI cut the blob
};

// Bit i of each mask is column box.left + i.
struct RowMasks {
  std::uint64_t near = 0;  // the blob itself and one pixel around it
  std::uint64_t rim = 0;   // one further out
};

class BoxSums {
 public:
  // Requires a box of at most 64 columns and rows. Rim pixels above the threshold belong to a
  // neighbour.
  BoxSums(const GrownBox& box, std::uint16_t threshold)
      : box_(box), threshold_(Words{} + static_cast<std::int16_t>(threshold ^ 0x8000)) {}

  // Requires the rows in order from box.top. row: the pixel at box.left; width: number of pixels of
  // the frame's row from there.
  template <class Pixel>
  void add_row(const Pixel* row, int width, const RowMasks& masks) {
    Pixel padded[64];
    if (width < 8 * box_.column_groups) {  // a frame narrower than the box
      std::memset(padded, 0, sizeof padded);
      std::memcpy(padded, row, static_cast<std::size_t>(width) * sizeof(Pixel));
      row = padded;
    }
    const Words one = Words{} + std::int16_t{1};
    Sums weight = weight_, x = x_, dark = dark_;
    Words pixels = pixels_, pixels_x = pixels_x_, dark_pixels = dark_pixels_, peak = peak_;
    Words bright = bright_rim_;
    for (int group = 0; group < box_.column_groups; ++group) {
      const Words value = load(row + 8 * group) ^ k_lowest;
      const Words column =
          Words{-32, -31, -30, -29, -28, -27, -26, -25} + static_cast<std::int16_t>(8 * group);
      const Words near = lane_mask(masks.near, group);
      const Words near_value = value & near;
      weight += pair_products(near_value, one);
      x += pair_products(near_value, column);
      pixels -= near;
      pixels_x += column & near;
      const Words rim = lane_mask(masks.rim, group), above = value > threshold_;
      const Words dark_rim = rim & ~above;
      dark += pair_products(value & dark_rim, one);
      dark_pixels -= dark_rim;
      bright |= rim & above;
      const Words masked_value = near_value | (k_lowest & ~near);
      peak = masked_value > peak ? masked_value : peak;
    }
    weight_ = weight, x_ = x, dark_ = dark;
    pixels_ = pixels, pixels_x_ = pixels_x, dark_pixels_ = dark_pixels, peak_ = peak;
    bright_rim_ = bright;
    weight_prefix_sum_ += weight;
    pixels_prefix_sum_ += pixels;
  }

  [[nodiscard]] GrownSums total() const {
    GrownSums out;
    const std::int64_t x = 2 * box_.left + 65, y = 2 * box_.bottom + 1;  // of column 32, row bottom
    const std::int64_t pixels_x = sum_of(pixels_x_), from_below = sum_of(pixels_prefix_sum_);
    out.pixels = sum_of(pixels_);
    out.pixels_x = x * out.pixels + 2 * pixels_x;
    out.pixels_y = y * out.pixels - 2 * from_below;
    out.weight = sum_of(weight_) + k_half * out.pixels;
    out.x = x * out.weight + 2 * (sum_of(x_) + k_half * pixels_x);
    out.y = y * out.weight - 2 * (sum_of(weight_prefix_sum_) + k_half * from_below);
    out.dark_pixels = sum_of(dark_pixels_);
    out.dark = sum_of(dark_) + k_half * out.dark_pixels;
    std::int16_t peak = peak_[0];
    for (int lane = 1; lane < 8; ++lane) peak = std::max(peak, peak_[lane]);
    out.peak = static_cast<std::uint16_t>(peak ^ 0x8000);
    std::uint64_t bright[2];
    std::memcpy(bright, &bright_rim_, sizeof bright);
    out.bright_rim = (bright[0] | bright[1]) != 0;
    return out;
  }

 private:
  static constexpr std::int64_t k_half = 1 << 15;
  // No overflow: a row adds 8 pairs below 2^16 to a lane of 32 bits, and 8 pixels to one of 16. The
  // sums of partial sums count the first row 64 times, the last once: 2080 * 2^19 < 2^31,
  // 2080 * 8 < 2^15. The columns of a lane, relative to column 32, sum to 80, in pairs to 160:
  // 64 * 160 * 2^15 < 2^31.
  static constexpr int k_rows_max = 64;
  static_assert(k_grown_box_max + 4 <= k_rows_max);
  static constexpr Words k_lowest = Words{} + std::int16_t{-32768};

  static Words load(const std::uint8_t* pixels) {
    std::uint8_t loaded __attribute__((vector_size(8)));
    std::memcpy(&loaded, pixels, sizeof loaded);
    return __builtin_convertvector(loaded, Words);
  }
  static Words load(const std::uint16_t* pixels) {
    Words loaded;
    std::memcpy(&loaded, pixels, sizeof loaded);
    return loaded;
  }

  // Sets all bits of a lane if the bit of its column is set.
  static Words lane_mask(std::uint64_t mask, int group) {
    const Words bits = {1, 2, 4, 8, 16, 32, 64, 128};
    const Words all = Words{} + static_cast<std::int16_t>(mask >> (8 * group) & 0xFF);
    return (all & bits) == bits;
  }

  GrownBox box_;
  Words threshold_;
  Sums weight_{}, weight_prefix_sum_{}, x_{}, dark_{};
  Words pixels_{}, pixels_prefix_sum_{}, pixels_x_{}, dark_pixels_{};
  Words peak_ = k_lowest, bright_rim_{};
};

}  // namespace glint
