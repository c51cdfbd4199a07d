#include "platform/sources/scenario_of.hpp"

#include <gtest/gtest.h>

namespace glint {
namespace {

TEST(ScenarioOf, TakesTheMarkersNoiseFromTheCell) {
  const sim::NoiseSettings usual = scenario_of(default_cell()).noise;
  Cell cell = default_cell();
  cell.simulator.marker_range_sigma_m = 0.007;
  EXPECT_EQ(scenario_of(cell).noise.blob_range_sigma_m, 0.007);
  EXPECT_EQ(scenario_of(cell).noise.blob_pixel_sigma_px, usual.blob_pixel_sigma_px);
  cell.simulator.marker_range_sigma_m.reset();
  cell.simulator.marker_pixel_sigma_px = 0.4;
  EXPECT_EQ(scenario_of(cell).noise.blob_range_sigma_m, usual.blob_range_sigma_m);
  EXPECT_EQ(scenario_of(cell).noise.blob_pixel_sigma_px, 0.4);
}

}  // namespace
}  // namespace glint
