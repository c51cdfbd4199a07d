#include "platform/sim/field.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "platform/sensors/camera.hpp"
#include "platform/sim/scenarios.hpp"
#include "platform/sim/scene.hpp"

namespace glint::sim {
namespace {

Time at_s(double seconds) { return {static_cast<std::int64_t>(seconds * 1e9)}; }

TEST(DeviceErrors, AreThoseThatAreStated) {
  DeviceErrors device;
  device.principal_point_px = {2, -1};
  device.focal_scale = 0.01;
  device.range_offset_m = 0.005;
  device.range_scale = 0.02;
  const MarkerError error = marker_error(device, {356, 206}, {256, 256}, 0.5, 0, {});
  EXPECT_DOUBLE_EQ(error.shift_px.x(), 2 + 1.0);
  EXPECT_DOUBLE_EQ(error.shift_px.y(), -1 - 0.5);
  EXPECT_DOUBLE_EQ(error.range_m, 0.005 + 0.01);
}

// Over many markers and times: as large as stated, alike within a tenth of a second, another after
// a minute, and each marker's own.
TEST(DeviceErrors, OfAMarkerChangeSlowly) {
  DeviceErrors device;
  device.slow_range_m = 0.002;
  device.slow_centroid_px = 0.1;
  double squares = 0, soon = 0, late = 0, beside = 0, pixel_squares = 0;
  int count = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    device.seed = seed;
    for (double s = 0; s < 200; s += 20) {
      const auto error = [&](std::uint64_t marker, double seconds) {
        return marker_error(device, {100, 100}, {256, 256}, 0.5, marker, at_s(seconds));
      };
      const double now = error(0, s).range_m;
      ++count;
      squares += now * now;
      soon += now * error(0, s + 0.1).range_m;
      late += now * error(0, s + 67).range_m;
      beside += now * error(1, s).range_m;
      pixel_squares += error(0, s).shift_px.squaredNorm();
    }
  }
  EXPECT_NEAR(std::sqrt(squares / count), 0.002, 0.0002);
  EXPECT_NEAR(std::sqrt(pixel_squares / (2 * count)), 0.1, 0.01);
  EXPECT_GT(soon / squares, 0.97);
  EXPECT_LT(std::abs(late / squares), 0.25);
  EXPECT_LT(std::abs(beside / squares), 0.25);
}

Scenario field(std::uint64_t seed) {
  return field_run(hololens2_ahat(), {}, {{Quaternion::Identity(), {1, 0, 0}}, 0.003, 0.005}, 30,
                   seed);
}

TEST(Field, DrawsOneDeviceARandomSeed) {
  const Scenario one = field(3), again = field(3), other = field(4);
  EXPECT_EQ(one.device.principal_point_px, again.device.principal_point_px);
  EXPECT_EQ(one.tools[0].tool.markers_m[1], again.tools[0].tool.markers_m[1]);
  EXPECT_EQ(one.localisation.T_stated_world->translation,
            again.localisation.T_stated_world->translation);
  EXPECT_NE(one.device.principal_point_px, other.device.principal_point_px);
  EXPECT_NE(one.tools[0].tool.markers_m[1], other.tools[0].tool.markers_m[1]);
  EXPECT_NE(one.timing.stamp_offset, other.timing.stamp_offset);
}

// Rms over devices of what the shipped settings state.
TEST(Field, DrawsErrorsAsLargeAsTheShippedSettingsState) {
  const CameraUncertainty shipped;
  const Scenario nominal = hand_held_run(hololens2_ahat(), {}, 1);
  double principal = 0, offset = 0, geometry = 0, tip = 0, robot = 0;
  constexpr int k_devices = 200;
  for (std::uint64_t seed = 1; seed <= k_devices; ++seed) {
    const Scenario drawn = field(seed);
    principal += drawn.device.principal_point_px.squaredNorm() / (2 * k_devices);
    offset += drawn.device.range_offset_m * drawn.device.range_offset_m / k_devices;
    geometry +=
        (drawn.tools[0].tool.markers_m[0] - nominal.tools[0].tool.markers_m[0]).squaredNorm() /
        (3 * k_devices);
    tip +=
        (drawn.tools[0].tool.tip_m - nominal.tools[0].tool.tip_m).squaredNorm() / (3 * k_devices);
    robot +=
        (*drawn.localisation.T_stated_world * Vector3(1, 0, 0) - Vector3(1, 0, 0)).squaredNorm() /
        (3 * k_devices);
  }
  EXPECT_NEAR(std::sqrt(principal), shipped.principal_point_px, 0.12 * shipped.principal_point_px);
  EXPECT_NEAR(std::sqrt(offset), shipped.range_offset_m, 0.15 * shipped.range_offset_m);
  EXPECT_NEAR(std::sqrt(geometry), Tool{}.marker_sigma_m, 0.12 * Tool{}.marker_sigma_m);
  EXPECT_NEAR(std::sqrt(tip), Tool{}.tip_sigma_m, 0.12 * Tool{}.tip_sigma_m);
  EXPECT_NEAR(std::sqrt(robot), 0.003, 0.0004) << "about the robot's base";
}

TEST(Field, MovesEachMarkersImageAndRangeByTheDevicesErrors) {
  Scenario drawn = field(5);
  drawn.noise.blob_pixel_sigma_px = drawn.noise.blob_range_sigma_m = 0;
  Scenario exact = drawn;
  exact.device = {};
  Scene off, on;
  build_scene(drawn, at_s(2), 90, off);
  build_scene(exact, at_s(2), 90, on);
  const CameraModel& model = drawn.camera.model;
  int markers = 0;
  for (int k = 0; k < off.reflectors.count; ++k) {
    const Reflector &moved = off.reflectors[k], &still = on.reflectors[k];
    ASSERT_EQ(moved.marker, still.marker);
    if (moved.tool < 0) {
      EXPECT_EQ(moved.centre, still.centre);
      continue;
    }
    ++markers;
    const Vector2 pixel = project(model, still.centre).value;
    const MarkerError error =
        marker_error(drawn.device, pixel, {model.cx, model.cy}, still.centre.norm(),
                     static_cast<std::uint64_t>(moved.marker), at_s(2));
    EXPECT_LT((project(model, moved.centre).value - pixel - error.shift_px).norm(), 1e-6);
    EXPECT_NEAR(moved.range_error_m, error.range_m, 1e-12);
    EXPECT_GT(error.shift_px.norm(), 0.1);
  }
  EXPECT_EQ(markers, drawn.tools[0].tool.marker_count);
}

}  // namespace
}  // namespace glint::sim
