#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "kernels/image/blob_settings.hpp"

namespace glint::size_gate_test {
namespace {

TEST(SizeGate, HoldsTheDiscOfEveryRangeBetween) {
  for (const double radius : {0.003, 0.006, 0.010}) {
    const SizeGate gate = size_gate(radius, 0.2, 1.0, 253);
    for (double range = 0.2; range <= 1.0; range += 0.05) {
      const double disc = std::numbers::pi * std::pow(253 * radius / range, 2);
      EXPECT_LE(gate.min_area_px, disc) << radius << " at " << range;
      EXPECT_GE(gate.max_area_px, disc) << radius << " at " << range;
    }
  }
}

TEST(SizeGate, ShutsOutWhatIsMuchLargerThanTheNearestMarker) {
  const SizeGate gate = size_gate(0.006, 0.2, 1.0, 253);
  EXPECT_LT(gate.max_area_px, 4 * std::numbers::pi * std::pow(253 * 0.006 / 0.2, 2));
  const SizeGate large = size_gate(0.012, 0.2, 0.5, 253);
  EXPECT_GT(large.min_area_px, 8u);
  EXPECT_GT(large.max_area_px, 2 * gate.max_area_px);
}

TEST(SizeGate, IsWideOpenForNonsense) {
  for (const SizeGate& gate : {size_gate(0, 0.2, 1, 253), size_gate(0.006, 0, 1, 253),
                               size_gate(0.006, 1, 0.2, 253), size_gate(NAN, 0.2, 1, 253)}) {
    EXPECT_EQ(gate.min_area_px, 1u);
    EXPECT_EQ(gate.max_area_px, 1024u * 1024u);
  }
}

// Minimum: 0.3 of the disc's area at the far range. Maximum: 1.5 of the area at the near range with
// a radius larger by one pixel, plus one pixel.
TEST(SizeGate, IsThePartOfTheDiscAtEachEnd) {
  for (const double radius : {0.002, 0.006, 0.02}) {
    for (const double near : {0.15, 0.4, 1.0}) {
      const SizeGate gate = size_gate(radius, near, 1.0, 253);
      const double far_px = 253 * radius / 1.0, near_px = 253 * radius / near + 1;
      const double least = 0.3 * std::numbers::pi * far_px * far_px;
      const double most = 1.5 * std::numbers::pi * near_px * near_px;
      EXPECT_EQ(gate.min_area_px, static_cast<unsigned>(std::max(least, 1.0))) << radius;
      EXPECT_EQ(gate.max_area_px, static_cast<unsigned>(most) + 1) << radius;
    }
  }
  EXPECT_EQ(size_gate(10, 0.1, 0.1, 253).min_area_px, 1024u * 1024u) << "no more than the frame";
  EXPECT_EQ(size_gate(10, 0.1, 0.1, 253).max_area_px, 1024u * 1024u + 1);
  EXPECT_EQ(size_gate(1e-9, 0.1, 0.1, 253).min_area_px, 1u);
}

TEST(SizeGate, IsWideOpenForEachFigureThatIsNone) {
  constexpr double k_none = std::numeric_limits<double>::quiet_NaN();
  const auto is_open = [](double radius, double near, double far, double focal) {
    const SizeGate gate = size_gate(radius, near, far, focal);
    return gate.min_area_px == 1u && gate.max_area_px == 1024u * 1024u;
  };
  EXPECT_FALSE(is_open(0.006, 0.2, 1, 253));
  EXPECT_FALSE(is_open(0.006, 0.2, 0.2, 253)) << "one range";
  EXPECT_FALSE(is_open(0.006, 0.2, 0.3, 0.5)) << "however short a lens";
  for (const double none : {0.0, -1.0, k_none}) {
    EXPECT_TRUE(is_open(none, 0.2, 1, 253)) << none;
    EXPECT_TRUE(is_open(0.006, none, 1, 253)) << none;
    EXPECT_TRUE(is_open(0.006, 0.2, none, 253)) << none;
    EXPECT_TRUE(is_open(0.006, 0.2, 1, none)) << none;
  }
}

MarkerOptics optics() { return {0.004, 0.007, 0.7, 253, 0.2, 1.5, 0.0005, 4090}; }

TEST(MarkerSizes, AreUnknownForEachFigureThatIsNone) {
  constexpr double k_none = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(marker_sizes(optics()).known);
  MarkerOptics little = optics();
  little.focal_px = little.range_max_m = 0.5;
  EXPECT_TRUE(marker_sizes(little).known) << "however short a lens";
  for (double MarkerOptics::*const figure :
       {&MarkerOptics::radius_min_m, &MarkerOptics::radius_max_m, &MarkerOptics::range_min_m,
        &MarkerOptics::range_max_m, &MarkerOptics::focal_px, &MarkerOptics::depth_unit_m}) {
    for (const double none : {0.0, -1.0, k_none}) {
      MarkerOptics invalid = optics();
      invalid.*figure = none;
      EXPECT_FALSE(marker_sizes(invalid).known) << none;
      EXPECT_EQ(marker_sizes(invalid).by_depth[20].max_area_px, 0u);
    }
  }
  MarkerOptics alike = optics();
  alike.radius_max_m = alike.radius_min_m;
  alike.range_max_m = alike.range_min_m;
  EXPECT_TRUE(marker_sizes(alike).known);
  alike.radius_max_m = 0.999 * alike.radius_min_m;
  EXPECT_FALSE(marker_sizes(alike).known);
  alike = optics();
  alike.range_max_m = 0.999 * alike.range_min_m;
  EXPECT_FALSE(marker_sizes(alike).known);
}

// For each depth: the smallest marker at the far end of its bin, the largest at the near end.
TEST(MarkerSizes, AreThoseOfTheBinsEndsWithinTheRanges) {
  const MarkerOptics o = optics();
  const MarkerSizes sizes = marker_sizes(o);
  EXPECT_EQ(sizes.depth_shift, 5);
  EXPECT_EQ(sizes.invalid_from, 4090);
  const auto expect_between = [&](const SizeGate& gate, double near_m, double far_m) {
    const double radius_px = o.focal_px * o.radius_min_m / far_m;
    const double least = std::ceil(0.7 * std::numbers::pi * radius_px * radius_px);
    EXPECT_EQ(gate.min_area_px, static_cast<unsigned>(std::max(least, 1.0))) << near_m;
    EXPECT_EQ(gate.max_area_px, size_gate(o.radius_max_m, near_m, far_m, o.focal_px).max_area_px);
  };
  expect_between(sizes.without_depth, o.range_min_m, o.range_max_m);
  for (int bin = 0; bin < k_depth_bins; ++bin) {
    const double from_m = 0.0005 * (32 * bin), to_m = 0.0005 * (32 * (bin + 1));
    expect_between(sizes.by_depth[static_cast<std::size_t>(bin)],
                   std::min(std::max(from_m, 0.2), 1.5), std::min(std::max(to_m, 0.2), 1.5));
  }
}

TEST(MarkerSizes, HaveTheFinestBinsThatHoldAllDepths) {
  for (const int invalid_from : {1, 2, 127, 128, 129, 256, 257, 4090, 0xFFFF}) {
    MarkerOptics o = optics();
    o.depth_invalid_from = static_cast<std::uint16_t>(invalid_from);
    const int shift = marker_sizes(o).depth_shift;
    EXPECT_LT((invalid_from - 1) >> shift, k_depth_bins) << invalid_from;
    if (shift > 0) {
      EXPECT_GE((invalid_from - 1) >> (shift - 1), k_depth_bins) << invalid_from;
    }
  }
}

}  // namespace
}  // namespace glint::size_gate_test
