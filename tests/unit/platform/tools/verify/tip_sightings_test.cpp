#include "platform/tools/verify/tip_sightings.hpp"

#include <gtest/gtest.h>

#include "platform/cells/tool_file.hpp"
#include "platform/sim/scenarios.hpp"
#include "platform/sim/touches.hpp"
#include "platform/sources/scenario_of.hpp"
#include "platform/sources/simulated_source.hpp"
#include "platform/tools/verify/holds.hpp"

namespace glint::tip_sightings_test {
namespace {

// A quarter of a second of the first touch, with pixel noise only and no drift.
Touch seen(const sim::DeviceErrors& device, const Vector3& moved_marker_m) {
  Cell cell = default_cell();
  cell.camera.estimate_noise = false;  // else a device error would change the weights
  sim::Scenario scenario = scenario_of(cell);
  sim::touch_points({}, 1, scenario);
  scenario.duration = milliseconds(250);
  scenario.noise.blob_pixel_sigma_px = scenario.noise.blob_range_sigma_m = 0;
  sim::LocalisationSettings& head = scenario.localisation;
  head.rest_position_m = head.rest_angle_rad = 0;
  head.position_per_speed_s = head.position_per_angular_speed_m = 0;
  head.angle_per_speed_s_m = head.angle_per_angular_speed_s = 0;
  scenario.device = device;
  scenario.device.exists = true;
  scenario.tools[0].tool.markers_m[2] += moved_marker_m;
  const sim::Simulator simulator(scenario);
  RecordedFrames recorded{"simulated", cell, std::make_unique<SimulatedSource>(simulator)};
  const TipSeries series = observe_tips(recorded, 0);
  EXPECT_GE(series.observations.size(), 10u);
  return mean_of(series, {0, series.observations.size(), 0.25});
}

// The tip moves as the sensitivities state if a device or a tool has the error.
TEST(TipSightings, StateHowEachErrorMovesTheTip) {
  const Touch plain = seen({}, Vector3::Zero());
  EXPECT_LT((plain.mean.tip_m - sim::TouchSettings{}.first_m).norm(), 0.001);
  const auto expect = [&](const sim::DeviceErrors& device, const Vector3& moved_m, int error,
                          double sigmas, const char* name) {
    const Vector3 moved = seen(device, moved_m).mean.tip_m - plain.mean.tip_m;
    const Vector3 stated = sigmas * plain.mean.by_calibration.col(error);
    EXPECT_GT(stated.norm(), 0.0002) << name;
    EXPECT_LT((moved - stated).norm(), 0.15 * stated.norm() + 0.00003)
        << name << ": " << moved.transpose() << " beside " << stated.transpose();
  };
  const CameraUncertainty stated;
  expect({.range_offset_m = 0.004}, Vector3::Zero(), 0, 0.004 / stated.range_offset_m, "offset");
  expect({.range_scale = -0.008}, Vector3::Zero(), 1, -0.008 / stated.range_scale, "scale");
  expect({.principal_point_px = {2, 0}}, Vector3::Zero(), 2, 2 / stated.principal_point_px,
         "right");
  expect({.principal_point_px = {0, 2}}, Vector3::Zero(), 3, 2 / stated.principal_point_px, "down");
  for (int axis = 0; axis < 3; ++axis) {
    expect({}, 0.0004 * Vector3::Unit(axis), k_common_errors + 3 * 2 + axis,
           0.0004 / Tool{}.marker_sigma_m, "marker");
  }
}

// A headset that drifts ten times as much as declared, in view of a reference body that shows it.
// The covariance of a touch contains the declared drift all the same; otherwise every touch would
// agree.
TEST(TipSightings, StateTheDeclaredDriftBesideABody) {
  const auto moving_of = [](bool is_reference) {
    Cell cell = default_cell();
    const int board = cell.tools.count++;
    cell.tools.items[static_cast<std::size_t>(board)] = reference_body();
    sim::Scenario scenario =
        sim::hand_held_run(cell.camera, {cell.tools.items[0], reference_body()}, 3);
    sim::lay_on_table(scenario, static_cast<std::size_t>(board));
    scenario.duration = milliseconds(3000);
    scenario.localisation.rest_position_m *= 10;
    scenario.localisation.rest_angle_rad *= 10;
    scenario.localisation.rest_correlation_s = 2;
    cell.reference = is_reference ? board : -1;
    const sim::Simulator simulator(scenario);
    RecordedFrames recorded{"simulated", cell, std::make_unique<SimulatedSource>(simulator)};
    return observe_tips(recorded, 0).observations.back().motion_covariance_m2;
  };
  const Matrix3 with_body = moving_of(true);
  EXPECT_GT(with_body.trace(), 0);
  EXPECT_TRUE(with_body.isApprox(moving_of(false)));
}

}  // namespace
}  // namespace glint::tip_sightings_test
