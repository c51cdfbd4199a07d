// The sums that a grown centroid needs, four columns at a time.
//
// What:     reflectivity, positions and number of the pixels near the blob; reflectivity and number
//           of the dark pixels around them; the blob's brightest pixel.
// Cost:     the same for every four columns of a row, whatever their masks.
// Worst:    none is worse than another.
// Accuracy: exact: 32-bit sums that cannot overflow, see k_one.
// Source:   sums of a column wait for their x, sums of a row for their y; so each pixel is only
//           added.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>

#include "kernels/image/grown_box.hpp"

namespace glint {

struct GrownSums {
  std::int64_t weight = 0, x = 0, y = 0;  // in half pixels: a centre is at 2 x + 1
  std::int64_t pixels = 0, pixels_x = 0, pixels_y = 0;
  std::int64_t dark = 0, dark_pixels = 0;
  std::uint16_t peak = 0;
};

// Bit i of each stands for column box.left + i.
struct RowMasks {
  std::uint64_t own = 0;   // the blob itself
  std::uint64_t near = 0;  // and one pixel around it
  std::uint64_t rim = 0;   // one further out
};

class ColumnSums {
 public:
  // box: at most 64 columns and rows. Rim pixels above the threshold belong to a neighbour.
  ColumnSums(const GrownBox& box, std::uint16_t threshold) : box_(box), threshold_(threshold) {
    for (int four = box.first_four; four < box.end_four; ++four) at(four) = Lanes{};
  }

  // row: the pixel of box.left; width: how many the frame has from there on.
  template <class Pixel>
  void add_row(const Pixel* row, int width, int y, const RowMasks& masks) {
    Pixel padded[64];
    if (width < 64) {  // a frame narrower than a box may be
      std::memset(padded, 0, sizeof padded);
      std::memcpy(padded, row, static_cast<std::size_t>(width) * sizeof(Pixel));
      row = padded;
    }
    Lanes near_sum{}, rim_sum{};
    for (int four = box_.first_four; four < box_.end_four; ++four) {
      const Lanes value = load(row + 4 * four);
      const Lanes counted = value | k_one;
      const Lanes near = counted & chosen(masks.near, four);
      at(four) += near;
      near_sum += near;
      rim_sum += counted & chosen(masks.rim, four) & (value <= threshold_);
      const Lanes own = value & chosen(masks.own, four);
      const Lanes brighter = own > peak_;
      peak_ = (own & brighter) | (peak_ & ~brighter);
    }
    const std::int64_t near = sum_of(near_sum), rim = sum_of(rim_sum);
    const std::int64_t weight = near & (k_one - 1), pixels = near >> k_one_bits;
    sums_.weight += weight;
    sums_.y += weight * (2 * y + 1);
    sums_.pixels += pixels;
    sums_.pixels_y += pixels * (2 * y + 1);
    sums_.dark += rim & (k_one - 1);
    sums_.dark_pixels += rim >> k_one_bits;
  }

  [[nodiscard]] GrownSums total() const {
    GrownSums out = sums_;
    for (int column = 4 * box_.first_four; column < 4 * box_.end_four; ++column) {
      const std::int64_t sum = columns_[static_cast<std::size_t>(column / 4)][column % 4];
      const std::int64_t x = 2 * (box_.left + column) + 1;
      out.x += (sum & (k_one - 1)) * x;
      out.pixels_x += (sum >> k_one_bits) * x;
    }
    for (int lane = 0; lane < 4; ++lane) {
      out.peak = std::max(out.peak, static_cast<std::uint16_t>(peak_[lane]));
    }
    return out;
  }

 private:
  using Lanes = std::int32_t __attribute__((vector_size(16)));

  // Counts stand above the reflectivities of 64 pixels: 64 * 65535 < 2^22, and 64 << 22 is 2^28.
  static constexpr int k_one_bits = 22;
  static constexpr std::int32_t k_one = 1 << k_one_bits;

  [[nodiscard]] Lanes& at(int four) { return columns_[static_cast<std::size_t>(four)]; }

  static Lanes load(const std::uint8_t* pixels) {
    std::uint8_t four __attribute__((vector_size(4)));
    std::memcpy(&four, pixels, sizeof four);
    return __builtin_convertvector(four, Lanes);
  }
  static Lanes load(const std::uint16_t* pixels) {
    std::uint16_t four __attribute__((vector_size(8)));
    std::memcpy(&four, pixels, sizeof four);
    return __builtin_convertvector(four, Lanes);
  }

  // All bits of a lane are set where the column's bit is.
  static Lanes chosen(std::uint64_t mask, int four) {
    const Lanes bits = {1, 2, 4, 8};
    const Lanes all = Lanes{} + static_cast<std::int32_t>(mask >> (4 * four) & 15);
    return (all & bits) == bits;
  }

  static std::int64_t sum_of(const Lanes& lanes) {
    return lanes[0] + lanes[1] + lanes[2] + lanes[3];
  }

  GrownBox box_;
  std::int32_t threshold_;
  std::array<Lanes, 16> columns_;
  Lanes peak_{};
  GrownSums sums_;
};

}  // namespace glint
