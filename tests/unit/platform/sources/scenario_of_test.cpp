#include "platform/sources/scenario_of.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "platform/input_error.hpp"

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

// The random seed's device follows from the uncertainties of the drawn cell, calibrated or not.
TEST(ScenarioOf, DrawsTheDeviceFromWhatWasStatedBeforeItsCalibration) {
  const std::string path = testing::TempDir() + "drawn_" + std::to_string(getpid()) + ".toml";
  std::ofstream(path) << "tools = [\"pen\"]\n[simulator]\nscenario = \"still\"\n";
  Cell cell = default_cell();
  cell.simulator.scenario = "field";
  cell.simulator.seed = 4;
  const sim::Scenario before = scenario_of(cell);
  cell.simulator.ground_truth_cell = path;
  cell.camera.model.cx += 3;
  Tool& tool = cell.tools.items[0];
  const Pose moved{Quaternion(1, 0.001, 0.002, 0).normalized(), {0.0002, -0.0001, 0.0003}};
  for (int i = 0; i < tool.marker_count; ++i) {
    Vector3& marker = tool.markers_m[static_cast<std::size_t>(i)];
    marker = moved * before.tools[0].tool.markers_m[static_cast<std::size_t>(i)];
  }
  tool.tip_m = Vector3(0.001, 0, 0);
  const sim::Scenario after = scenario_of(cell);
  EXPECT_EQ(after.camera.model.cx, before.camera.model.cx);
  EXPECT_EQ(after.device.principal_point_px, before.device.principal_point_px);
  const sim::ToolBody &was = before.tools[0], &is = after.tools[0];
  EXPECT_EQ(is.tool.tip_m, tool.tip_m);
  const Time at{2'000'000'000};
  const Pose T_world_was = was.motion->pose(at), T_world_is = is.motion->pose(at);
  EXPECT_LT((T_world_was * was.tool.tip_m - T_world_is * is.tool.tip_m).norm(), 1e-9);
  EXPECT_LT((T_world_was * was.tool.markers_m[2] - T_world_is * is.tool.markers_m[2]).norm(), 1e-9);
  EXPECT_LT(
      (T_world_was.rotation * moved.rotation.conjugate()).angularDistance(T_world_is.rotation),
      1e-6);
  tool.marker_count = 4;
  EXPECT_THROW((void)scenario_of(cell), InputError);
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace glint
