#include <gtest/gtest.h>

#include <cmath>
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

}  // namespace
}  // namespace glint::size_gate_test
