#include "platform/sim/scenarios.hpp"

#include <gtest/gtest.h>

#include <bit>

#include "platform/sim/simulator.hpp"
#include "tests/unit/repetitions.hpp"

namespace glint::sim {
namespace {

int visible(const SimFrame& frame) { return std::popcount(frame.truth.visible_mask[0]); }

TEST(DefaultRun, ShowsAllThatATrackerMustStand) {
  const Simulator simulator(default_run());
  SimFrame frame;
  int frames = 0, tracked = 0, away = 0, hidden = 0, slow = 0;
  for (int i = 0; i < simulator.frame_count(); i += test::repetitions(12, 18)) {
    simulator.render(i, frame);
    const double t = Duration{frame.mid_exposure.nanoseconds}.seconds();
    ++frames;
    if (t > 40.3 && t < 41.7) away += visible(frame) == 0 ? 1 : 100;
    if (t > 30.3 && t < 30.7) hidden += visible(frame) < 3 ? 1 : 100;
    tracked += visible(frame) >= 4 ? 1 : 0;
  }
  for (int i = 1; i < simulator.frame_count(); ++i) {
    const Duration gap = simulator.timing(i).exposed - simulator.timing(i - 1).exposed;
    slow += gap == milliseconds(200) ? 1 : 0;
  }
  EXPECT_EQ(slow, 20);
  EXPECT_GE(away, 1);
  EXPECT_LT(away, 100);
  EXPECT_GE(hidden, 1);
  EXPECT_LT(hidden, 100);
  EXPECT_GT(tracked, 0.85 * frames);
}

TEST(DefaultRun, KeepsThePenAtArmsLength) {
  const Simulator simulator(default_run());
  SimFrame frame;
  for (int i = 0; i < simulator.frame_count(); ++i) {
    simulator.describe(i, frame);
    const double t = Duration{frame.mid_exposure.nanoseconds}.seconds();
    if (t > 39.9 && t < 42.1) continue;
    const Pose T_camera_tool = frame.truth.T_world_camera.inverse() * frame.truth.T_world_tool[0];
    const double range = (T_camera_tool * Vector3(0, 0, 0.16)).norm();
    ASSERT_GT(range, 0.3) << t;
    ASSERT_LT(range, 0.75) << t;
  }
}

TEST(Experiments, StandStillAndMoveAsTheyShould) {
  const Simulator still(experiment_static());
  EXPECT_EQ(still.frame_count(), k_aligning_frames + k_static_frames);
  SimFrame first, last;
  still.describe(0, first);
  still.describe(still.frame_count() - 1, last);
  EXPECT_EQ(first.truth.T_world_camera.translation, last.truth.T_world_camera.translation);
  EXPECT_EQ(first.truth.T_world_tool[0].translation, last.truth.T_world_tool[0].translation);

  const Simulator moving(experiment_dynamic(0));
  EXPECT_EQ(moving.frame_count(), k_aligning_frames + k_dynamic_frames);
  double head = 0, pen = 0;
  moving.describe(k_aligning_frames - 1, first);
  EXPECT_LT(
      (moving.truth_camera(Time{}).translation - first.truth.T_world_camera.translation).norm(),
      1e-12);
  for (int i = k_aligning_frames; i < moving.frame_count(); i += 10) {
    moving.describe(i, last);
    head = std::max(
        head,
        (last.truth.T_world_camera.translation - first.truth.T_world_camera.translation).norm());
    pen = std::max(
        pen,
        (last.truth.T_world_tool[0].translation - first.truth.T_world_tool[0].translation).norm());
  }
  EXPECT_GT(head, 0.05);
  EXPECT_GT(pen, 0.05);
}

TEST(Experiments, ShareOneSetOfErrorSources) {
  const Scenario a = experiment_static(), b = experiment_dynamic(2);
  EXPECT_EQ(a.noise.blob_range_sigma_m, b.noise.blob_range_sigma_m);
  EXPECT_EQ(a.noise.blob_pixel_sigma_px, b.noise.blob_pixel_sigma_px);
  EXPECT_EQ(a.localisation.angle_per_angular_speed_s, b.localisation.angle_per_angular_speed_s);
  EXPECT_EQ(a.localisation.rest_position_m, b.localisation.rest_position_m);
  EXPECT_NE(experiment_dynamic(0).seed, experiment_dynamic(1).seed);
}

TEST(TrajectoryRun, CarriesThePenBeforeTheRecordedHead) {
  Trajectory head, pen;
  for (int i = 0; i < 40; ++i) {
    const double t = 0.05 * i;
    const Time when{i * 50'000'000LL};
    head.samples.push_back({when, {from_rotation_vector({0, t, 0}), Vector3(t, 0, 0)}});
    pen.samples.push_back({when, {Quaternion::Identity(), Vector3(0, t, 0)}});
  }
  const Simulator simulator(trajectory_run(hololens2_ahat(), {}, head, pen, 0.1));
  SimFrame frame;
  double low = 1, high = -1;
  for (int i = 0; i < simulator.frame_count(); i += 8) {
    simulator.render(i, frame);
    EXPECT_GE(visible(frame), 4) << i;
    const Pose T_camera_tool = frame.truth.T_world_camera.inverse() * frame.truth.T_world_tool[0];
    low = std::min(low, T_camera_tool.translation.dot(Vector3(1, 1, 1).normalized()));
    high = std::max(high, T_camera_tool.translation.dot(Vector3(1, 1, 1).normalized()));
  }
  EXPECT_LT(high - low, 0.2);
  const double moved = (simulator.truth_camera(Time{1'900'000'000}).translation -
                        simulator.truth_camera(Time{}).translation)
                           .norm();
  EXPECT_NEAR(moved, 1.9, 0.02);
}

}  // namespace
}  // namespace glint::sim
