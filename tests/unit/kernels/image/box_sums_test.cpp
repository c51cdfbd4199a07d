#include "kernels/image/box_sums.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace glint::box_sums_test {
namespace {

struct Box {
  GrownBox box;
  std::vector<RowMasks> masks;
  std::vector<std::uint16_t> pixels;  // 64 a row, for any box
};

// Per-pixel reference.
GrownSums reference_sums(const Box& from, std::uint16_t threshold) {
  GrownSums out;
  for (int row = 0; row < from.box.bottom - from.box.top; ++row) {
    const RowMasks& masks = from.masks[static_cast<std::size_t>(row)];
    const std::int64_t y = 2 * (from.box.top + row) + 1;
    for (int column = 0; column < 8 * from.box.column_groups; ++column) {
      const std::uint16_t value = from.pixels[static_cast<std::size_t>(64 * row + column)];
      const std::int64_t x = 2 * (from.box.left + column) + 1;
      const auto is_in = [&](std::uint64_t mask) { return (mask >> column & 1) != 0; };
      if (is_in(masks.near)) {
        out.peak = std::max(out.peak, value);
        out.weight += value;
        out.x += value * x;
        out.y += value * y;
        out.pixels += 1;
        out.pixels_x += x;
        out.pixels_y += y;
      }
      if (is_in(masks.rim) && value <= threshold) {
        out.dark += value;
        out.dark_pixels += 1;
      }
      if (is_in(masks.rim) && value > threshold) out.bright_rim = true;
    }
  }
  return out;
}

GrownSums sums_of(const Box& from, std::uint16_t threshold) {
  BoxSums sums(from.box, threshold);
  for (std::size_t row = 0; row < from.masks.size(); ++row) {
    sums.add_row(&from.pixels[64 * row], 64, from.masks[row]);
  }
  return sums.total();
}

void expect_same(const GrownSums& a, const GrownSums& b) {
  EXPECT_EQ(a.weight, b.weight);
  EXPECT_EQ(a.x, b.x);
  EXPECT_EQ(a.y, b.y);
  EXPECT_EQ(a.pixels, b.pixels);
  EXPECT_EQ(a.pixels_x, b.pixels_x);
  EXPECT_EQ(a.pixels_y, b.pixels_y);
  EXPECT_EQ(a.dark, b.dark);
  EXPECT_EQ(a.dark_pixels, b.dark_pixels);
  EXPECT_EQ(a.peak, b.peak);
  EXPECT_EQ(a.bright_rim, b.bright_rim);
}

TEST(BoxSums, AreThoseOfAPlainLoop) {
  std::mt19937_64 random(9);
  for (int round = 0; round < 400; ++round) {
    Box from;
    from.box.left = static_cast<int>(random() % 400);
    from.box.top = static_cast<int>(random() % 400);
    from.box.column_groups = static_cast<int>(1 + random() % 8);
    from.box.bottom = from.box.top + static_cast<int>(1 + random() % 64);
    for (int row = from.box.top; row < from.box.bottom; ++row) {
      const std::uint64_t near = random() | random();
      from.masks.push_back({near, random() & ~near});
      for (int i = 0; i < 64; ++i) from.pixels.push_back(static_cast<std::uint16_t>(random()));
    }
    const auto threshold = static_cast<std::uint16_t>(random());
    expect_same(sums_of(from, threshold), reference_sums(from, threshold));
    ASSERT_FALSE(HasFailure()) << "round " << round;
  }
}

// One bright pixel in the last row of the rim, in each column.
TEST(BoxSums, SeeASingleBrightPixelOfTheRim) {
  for (int column = 0; column < 64; ++column) {
    for (const int brighter : {0, 1}) {
      Box from;
      from.box = {0, 8, 0, 3};
      from.masks.assign(3, RowMasks{0, ~std::uint64_t{0}});
      from.pixels.assign(3 * 64, 20);
      from.pixels[static_cast<std::size_t>(2 * 64 + column)] =
          static_cast<std::uint16_t>(1000 + brighter);
      EXPECT_EQ(sums_of(from, 1000).bright_rim, brighter == 1) << column;
    }
  }
}

// Every lane at its maximum or minimum.
TEST(BoxSums, DoNotOverflow) {
  for (const std::uint16_t value : {0, 0xFFFF}) {
    for (const bool rim : {false, true}) {
      Box from;
      from.box = {448, 8, 448, 512};
      const std::uint64_t all = ~std::uint64_t{0};
      from.masks.assign(64, rim ? RowMasks{0, all} : RowMasks{all, 0});
      from.pixels.assign(64 * 64, value);
      expect_same(sums_of(from, 0xFFFF), reference_sums(from, 0xFFFF));
    }
  }
}

}  // namespace
}  // namespace glint::box_sums_test
