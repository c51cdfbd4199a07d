#include "platform/sim/visibility.hpp"

#include <gtest/gtest.h>

#include "small_scene.hpp"

namespace glint::sim {
namespace {

int mask_of(const Scenario& scenario) {
  SimFrame frame;
  Simulator(scenario).render(0, frame);
  return frame.truth.visible_mask.front();
}

TEST(Visible, AreAllMarkersThatNothingHides) { EXPECT_EQ(mask_of(dark_scene()), 0b11111); }

TEST(Visible, IsNoMarkerBehindAFinger) {
  Scenario scenario = dark_scene();
  // Between the camera and marker 1, which is at (53, 8, 510) mm.
  scenario.tools[0].parts.push_back({{0.04, 0.008, -0.05}, {0.06, 0.008, -0.05}, 0.008, 300});
  EXPECT_EQ(mask_of(scenario), 0b11101);
}

TEST(Visible, IsAMarkerBeforeAHand) {
  Scenario scenario = dark_scene();
  scenario.tools[0].parts.push_back({{0.03, 0.01, 0.06}, {0.07, 0.01, 0.06}, 0.02, 300});
  EXPECT_EQ(mask_of(scenario), 0b11111);
}

TEST(Visible, IsNoMarkerThatTheShaftCovers) {
  Scenario scenario = dark_scene();
  scenario.tools[0].parts.push_back({{0, 0, -0.02}, {0.1, 0.02, -0.005}, 0.005, 90});
  EXPECT_EQ(mask_of(scenario) & 0b00011, 0);
}

TEST(Visible, IsNoMarkerThatTheFrameCuts) {
  // The column of marker 2 is 80 - 253 * (x + 0.045) / 0.49; 2 px from the border.
  EXPECT_EQ(mask_of(dark_scene({-0.106, 0, 0.5})), 0b11011);
  EXPECT_EQ(mask_of(dark_scene({-0.095, 0, 0.5})), 0b11111);
}

TEST(Visible, IsNoMarkerOutOfRange) {
  EXPECT_EQ(mask_of(dark_scene({0, 0, 1.2})), 0);
  EXPECT_EQ(mask_of(dark_scene({0, 0, 0.97})), 0b11111);
}

// The edge of a thick vertical line is beside the centre of marker 0, at (3, -2, 500) mm.
Scenario with_edge_beside_marker_0(double beside_radii) {
  Scenario scenario = dark_scene();
  const double edge_mm = 0.9 * (3 + beside_radii * 5.5);  // in the plane at 450 mm
  const double axis_m = 0.001 * (edge_mm + 4 - 3);
  scenario.tools[0].parts.push_back({{axis_m, -0.03, -0.05}, {axis_m, 0.03, -0.05}, 0.004, 300});
  return scenario;
}

// A line at 0.6 radii leaves 86 % of the disc visible; at 0.4 radii, 75 %.
TEST(Visible, IsAMarkerWhoseDiscIsOpenByFourFifths) {
  EXPECT_EQ(mask_of(with_edge_beside_marker_0(0.6)), 0b11111);
  EXPECT_EQ(mask_of(with_edge_beside_marker_0(0.4)), 0b11110);
}

TEST(Visible, IsNoMarkerThatTheLensCutsByMoreThanAFifth) {
  // Marker 2 is at (-42, 28, 490) mm: its centre is at a tangent of 0.1030 from the optical axis,
  // its rim 0.0112 further.
  Scenario scenario = dark_scene();
  scenario.camera.model.lens = Lens::rational;
  scenario.camera.model.field_tangent_max = 0.1108;
  EXPECT_EQ(mask_of(scenario) & 0b00100, 0b00100);
  scenario.camera.model.field_tangent_max = 0.1052;
  EXPECT_EQ(mask_of(scenario) & 0b00100, 0);
}

// Ground truth visibility does not depend on the tracker's threshold.
TEST(Visible, IsAMarkerDarkerThanTheThreshold) {
  Scenario scenario = dark_scene();
  scenario.signal.marker = 1200;
  EXPECT_EQ(mask_of(scenario), 0b11111);
}

TEST(Visible, IsNoMarkerThatMergesWithClutter) {
  Scenario scenario = dark_scene();
  scenario.clutter.push_back({{0.012, -0.002, 0.55}, Vector3::Zero(), 0.005, 8000});
  EXPECT_EQ(mask_of(scenario), 0b11110);
  // Behind a finger the clutter merges with no marker.
  scenario.tools[0].parts.push_back({{0.008, -0.02, 0.03}, {0.008, 0.02, 0.03}, 0.008, 300});
  EXPECT_EQ(mask_of(scenario), 0b11111);
}

TEST(Visible, IsNothingWhileAHandPassesBefore) {
  Scenario scenario = dark_scene();
  scenario.duration = milliseconds(2000);
  scenario.occlusions.push_back({{Time{500'000'000}, Time{1'500'000'000}}, 0, 0.09, 0.6});
  const Simulator simulator(scenario);
  SimFrame frame;
  simulator.render(10, frame);
  EXPECT_EQ(frame.truth.visible_mask[0], 0b11111);
  simulator.render(45, frame);
  EXPECT_EQ(frame.truth.visible_mask[0], 0);
  for (const auto pixel : frame.pixels.reflectivity_16) ASSERT_LT(pixel, 3000);  // the hand
  simulator.render(80, frame);
  EXPECT_EQ(frame.truth.visible_mask[0], 0b11111);
}

TEST(Visible, IsNothingWhileThePenIsAway) {
  Scenario scenario = dark_scene();
  scenario.duration = milliseconds(2000);
  scenario.absences.push_back({{Time{500'000'000}, Time{1'500'000'000}}, 0, Vector3(0, -1, 0)});
  const Simulator simulator(scenario);
  SimFrame frame;
  simulator.render(45, frame);
  EXPECT_EQ(frame.truth.visible_mask[0], 0);
  EXPECT_NEAR(frame.truth.T_world_tool[0].translation.y(), -1.002, 1e-9);
  simulator.render(80, frame);
  EXPECT_EQ(frame.truth.visible_mask[0], 0b11111);
}

TEST(Saturation, LeavesTheMarkersCoreWithoutDepth) {
  Scenario scenario = dark_scene();
  scenario.signal.marker = 20'000;
  scenario.signal.sphere_limb = 0.5;
  scenario.noise.depth_saturation = 16'000;
  SimFrame frame;
  Simulator(scenario).render(0, frame);
  for (int i = 0; i < 5; ++i) {
    const Measured measured = measure(frame, projected(scenario, i));
    EXPECT_GE(measured.zero_depths, 5);
    EXPECT_GE(measured.bright - measured.zero_depths, 5);  // the annulus still has depth
  }
}

}  // namespace
}  // namespace glint::sim
