#include "platform/sim/field.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "platform/formats/camera.hpp"
#include "platform/sim/chessboard.hpp"
#include "platform/sim/scenarios.hpp"
#include "platform/sim/scene.hpp"
#include "platform/sim/tool_body.hpp"
#include "tests/unit/repetitions.hpp"

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

// Over many markers and times the error has the stated rms. It is correlated over a tenth of a
// second, uncorrelated over a minute and between markers.
TEST(DeviceErrors, OfAMarkerChangeSlowly) {
  DeviceErrors device;
  device.correlated_range_m = 0.002;
  device.correlated_centroid_px = 0.1;
  double squares = 0, soon = 0, late = 0, between_markers = 0, pixel_squares = 0;
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
      between_markers += now * error(1, s).range_m;
      pixel_squares += error(0, s).shift_px.squaredNorm();
    }
  }
  EXPECT_NEAR(std::sqrt(squares / count), 0.002, 0.0002);
  EXPECT_NEAR(std::sqrt(pixel_squares / (2 * count)), 0.1, 0.01);
  EXPECT_GT(soon / squares, 0.97);
  EXPECT_LT(std::abs(late / squares), 0.25);
  EXPECT_LT(std::abs(between_markers / squares), 0.25);
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

// The rms error over devices equals that of the shipped settings.
TEST(Field, DrawsErrorsAsLargeAsTheShippedSettingsState) {
  const CameraUncertainty shipped;
  const Scenario nominal = hand_held_run(hololens2_ahat(), {}, 1);
  double principal = 0, offset = 0, geometry = 0, tip = 0, robot = 0;
  const Tool& stated = nominal.tools[0].tool;
  const auto count = static_cast<double>(stated.marker_count);
  const int devices = test::repetitions(200, 50);
  const double scatter = std::sqrt(200.0 / devices);  // of the sums
  for (int seed = 1; seed <= devices; ++seed) {
    const Scenario drawn = field(static_cast<std::uint64_t>(seed));
    principal += drawn.device.principal_point_px.squaredNorm() / (2 * devices);
    offset += drawn.device.range_offset_m * drawn.device.range_offset_m / devices;
    // The tip has its nominal position in the tool's frame; all markers are offset.
    const Tool& made = drawn.tools[0].tool;
    EXPECT_EQ(made.tip_m, stated.tip_m);
    const Vector3 off = made.middle_m() - stated.middle_m();
    const Vector3 own = made.markers_m[0] - stated.markers_m[0] - off;
    geometry += own.squaredNorm() / (3 * devices) / (1 - 1 / count);
    tip += off.squaredNorm() / (3 * devices);
    robot +=
        (*drawn.localisation.T_stated_world * Vector3(1, 0, 0) - Vector3(1, 0, 0)).squaredNorm() /
        (3 * devices);
  }
  EXPECT_NEAR(std::sqrt(principal), shipped.principal_point_px,
              0.12 * scatter * shipped.principal_point_px);
  EXPECT_NEAR(std::sqrt(offset), shipped.range_offset_m, 0.15 * scatter * shipped.range_offset_m);
  EXPECT_NEAR(std::sqrt(geometry), Tool{}.marker_sigma_m, 0.12 * scatter * Tool{}.marker_sigma_m);
  const double tip_sigma_m =
      std::hypot(Tool{}.tip_sigma_m, Tool{}.marker_sigma_m / std::sqrt(count));
  EXPECT_NEAR(std::sqrt(tip), tip_sigma_m, 0.12 * scatter * tip_sigma_m);
  EXPECT_NEAR(std::sqrt(robot), 0.003, 0.0004 * scatter) << "about the robot's base";
}

TEST(Field, MovesEachMarkersImageAndRangeByTheDevicesErrors) {
  Scenario drawn = field(5);
  drawn.noise.blob_pixel_sigma_px = drawn.noise.blob_range_sigma_m = 0;
  drawn.device.dim_m = 0.004;
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
    const double counts = still.signal * 0.25 / still.centre.squaredNorm();
    EXPECT_NEAR(moved.range_error_m, error.range_m + 0.004 * 1000 / counts, 1e-12);
    EXPECT_GT(error.shift_px.norm(), 0.1);
  }
  EXPECT_EQ(markers, drawn.tools[0].tool.marker_count);
}

// The device is the same for each calibration, with the tool alone; the head is static except for
// FieldTask::move_head.
TEST(Field, ShowsTheSameDeviceForEachCalibration) {
  const Scenario work = field(3);
  for (const FieldTask task : {FieldTask::target, FieldTask::rotate, FieldTask::pivot,
                               FieldTask::still, FieldTask::move_head}) {
    const Scenario shown = field_run(
        hololens2_ahat(), {}, {{Quaternion::Identity(), {1, 0, 0}}, 0.003, 0.005}, 30, 3, task);
    EXPECT_EQ(shown.device.principal_point_px, work.device.principal_point_px);
    EXPECT_EQ(shown.device.range_offset_m, work.device.range_offset_m);
    EXPECT_EQ(shown.tools[0].tool.markers_m[2], work.tools[0].tool.markers_m[2]);
    EXPECT_EQ(shown.localisation.rest_position_m, work.localisation.rest_position_m);
    EXPECT_TRUE(shown.clutter.empty());
    EXPECT_TRUE(shown.occlusions.empty() && shown.absences.empty() && shown.timing.slow.empty());
    EXPECT_EQ(shown.calibration_target.has_value(), task == FieldTask::target);
    const auto moved = [&](const MotionPointer& motion, const Vector3& point) {
      return (motion->pose(at_s(12)) * point - motion->pose(at_s(3)) * point).norm();
    };
    const ToolBody& body = shown.tools[0];
    EXPECT_EQ(moved(shown.head, Vector3::Zero()) > 0.001, task == FieldTask::move_head);
    if (task == FieldTask::pivot) {
      EXPECT_LT(moved(body.motion, body.tool.tip_m), 0.0005);
      EXPECT_GT(moved(body.motion, body.tool.markers_m[0]), 0.01);
    }
    if (task == FieldTask::rotate) {
      EXPECT_GT(moved(body.motion, body.tool.tip_m), 0.02);
    }
    if (task == FieldTask::still) {
      EXPECT_EQ(moved(body.motion, body.tool.markers_m[0]), 0);
    }
  }
}

TEST(ToolBody, IsTheSameInAFrameWhoseTipIsAsStated) {
  Scenario scenario = field(8);
  ToolBody& body = scenario.tools[0];
  const ToolBody before = body;
  const Quaternion turn = Quaternion(1, 0.02, -0.01, 0.03).normalized();
  align_to_stated_frame({0.001, 0.002, -0.003}, turn, body);
  EXPECT_EQ(body.tool.tip_m, Vector3(0.001, 0.002, -0.003));
  const Pose was = before.motion->pose(at_s(4)), is = body.motion->pose(at_s(4));
  EXPECT_LT((was * before.tool.tip_m - is * body.tool.tip_m).norm(), 1e-12);
  EXPECT_LT((was * before.tool.markers_m[3] - is * body.tool.markers_m[3]).norm(), 1e-12);
  EXPECT_LT((was * before.parts[0].a - is * body.parts[0].a).norm(), 1e-12);
  EXPECT_LT((was.rotation * before.disc_normal - is.rotation * body.disc_normal).norm(), 1e-12);
  EXPECT_NEAR(was.rotation.angularDistance(is.rotation), 2 * std::acos(turn.w()), 1e-9);
}

// A corner has the mean of black and white, for any lens and tilt.
TEST(Chessboard, HasItsCornersWhereTheDevicesLensPutsThem) {
  const CameraModel model = hololens2_ahat().model;
  DeviceErrors device;
  device.exists = true;
  device.principal_point_px = {2.3, -1.4};
  device.focal_scale = 0.004;
  Chessboard board;
  board.white_signal = 2000;
  board.black_signal = 0;
  const Pose T_camera_board{Quaternion(0.95, 0.2, -0.15, 0.1).normalized(), {-0.1, -0.06, 0.4}};
  Planes planes;
  planes.resize(model.width, model.height);
  ChessboardDrawer(model, device).draw(board, T_camera_board, planes);
  for (const auto& [column, row] : {std::pair(1, 1), std::pair(4, 3), std::pair(7, 4)}) {
    const Vector3 corner = T_camera_board * Vector3(0.025 * column, 0.025 * row, 0);
    const Vector2 ideal = project(model, corner).value;
    const Vector2 pixel =
        ideal + marker_error(device, ideal, {model.cx, model.cy}, 0, 0, {}).shift_px;
    // Bilinear interpolation of the four pixels around it.
    const Vector2 at = pixel - Vector2(0.5, 0.5);
    const int x = static_cast<int>(at.x()), y = static_cast<int>(at.y());
    const auto counts = [&](int i, int j) {
      const std::size_t k = planes.at(x + i, y + j);
      const double range = static_cast<double>(planes.range_m[k]);
      return static_cast<double>(planes.signal[k]) * range * range / 0.25;
    };
    const double u = at.x() - x, v = at.y() - y;
    const double seen = (1 - v) * ((1 - u) * counts(0, 0) + u * counts(1, 0)) +
                        v * ((1 - u) * counts(0, 1) + u * counts(1, 1));
    EXPECT_NEAR(seen, 1000, 60) << column << " " << row;
    EXPECT_GT(std::abs(counts(3, 0) - 1000) + std::abs(counts(0, 3) - 1000), 500);
  }
}

}  // namespace
}  // namespace glint::sim
