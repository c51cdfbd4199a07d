#include "platform/lab/baseline/baseline_tracker.hpp"

#include <gtest/gtest.h>

#include "kernels/angles.hpp"
#include "painted_frame.hpp"

namespace glint::baseline_tracker_test {
namespace {

const Pose k_pose = turned(0.4, -0.3, 1.1, {0.05, -0.02, 0.45});

HeadPose no_head() { return {}; }

HeadPose head_at(const Pose& T_world_camera) {
  HeadPose head;
  head.valid = true;
  head.T_world_camera = T_world_camera;
  return head;
}

class SeedOnBothCameras : public testing::TestWithParam<int> {
 protected:
  Camera camera = GetParam() == 8 ? hololens1_short_throw() : hololens2_ahat();
  Tool tool = small_tool();
  BaselineTracker tracker{camera, tool};
};

INSTANTIATE_TEST_SUITE_P(Bits, SeedOnBothCameras, testing::Values(8, 16));

TEST_P(SeedOnBothCameras, FindsTheBlobsWhereAPinholeSeesTheMarkers) {
  const FrameBuffer buffer = rendered_frame(camera, tool, k_pose);
  const auto blobs = tracker.front_end(buffer.view({}, {}, 0));
  ASSERT_EQ(blobs.size(), 5u);
  for (int i = 0; i < tool.marker_count; ++i) {
    const Vector3 point = k_pose * tool.markers_m[static_cast<std::size_t>(i)];
    const Vector2 pixel(camera.model.fx * point.x() / point.z() + camera.model.cx,
                        camera.model.fy * point.y() / point.z() + camera.model.cy);
    double nearest = 1e9;
    for (const BaselineBlob& blob : blobs)
      nearest = std::min(nearest, (blob.centre_px - pixel).norm());
    EXPECT_LT(nearest, 1.0) << "marker " << i;  // half a pixel at half resolution
  }
}

TEST_P(SeedOnBothCameras, GivesThePoseOfACleanFrame) {
  const FrameBuffer buffer = rendered_frame(camera, tool, k_pose);
  const BaselineResult result = tracker.process(buffer.view({}, {}, 0), no_head());
  ASSERT_EQ(result.reason, Reason::none);
  EXPECT_EQ(result.marker_count, 5);
  EXPECT_FALSE(result.from_roi);
  EXPECT_LT((result.T_camera_tool.translation - k_pose.translation).norm(), 0.0015);
  EXPECT_LT(result.T_camera_tool.rotation.angularDistance(k_pose.rotation),
            1.0 * k_radians_per_degree);
}

TEST_P(SeedOnBothCameras, LooksAroundThePredictionAndThenEverywhere) {
  const auto time = [](int n) { return Time{n * 20'000'000}; };
  const FrameBuffer first = rendered_frame(camera, tool, k_pose);
  EXPECT_FALSE(tracker.process(first.view(time(1), {}, 1), no_head()).from_roi);
  const BaselineResult second = tracker.process(first.view(time(2), {}, 2), no_head());
  EXPECT_TRUE(second.from_roi);
  EXPECT_EQ(second.marker_count, 5);
  const Pose jumped = turned(0.4, -0.3, 1.1, {-0.12, 0.1, 0.45});
  const FrameBuffer away = rendered_frame(camera, tool, jumped);
  const BaselineResult third = tracker.process(away.view(time(3), {}, 3), no_head());
  EXPECT_EQ(third.reason, Reason::none);
  EXPECT_FALSE(third.from_roi);
}

TEST_P(SeedOnBothCameras, GivesTheSamePoseWhereverItUndistorts) {
  const Pose pose = turned(0.4, -0.3, 1.1, {-0.15, 0.12, 0.45});  // at strong lens distortion
  const FrameBuffer buffer = rendered_frame(camera, tool, pose);
  for (const auto undistortion : {BaselineUndistortion::roi, BaselineUndistortion::points}) {
    BaselineSettings settings;
    settings.undistortion = undistortion;
    BaselineTracker variant(camera, tool, settings);
    for (int i = 1; i <= 2; ++i) {
      const BaselineResult result =
          variant.process(buffer.view(Time{i * 20'000'000}, {}, 0), no_head());
      ASSERT_EQ(result.reason, Reason::none);
      EXPECT_EQ(result.marker_count, 5);
      EXPECT_EQ(result.from_roi, i == 2);
      EXPECT_LT((result.T_camera_tool.translation - pose.translation).norm(), 0.0015);
      EXPECT_LT(result.T_camera_tool.rotation.angularDistance(pose.rotation),
                1.0 * k_radians_per_degree);
    }
  }
}

TEST(Seed, PredictsAcrossTheHeadsOwnMotion) {
  const Camera camera = hololens1_short_throw();
  BaselineTracker tracker(camera, small_tool());
  const Pose T_world_pen = k_pose;
  for (int i = 0; i < 4; ++i) {
    // 25 mm and 4 degrees a frame: outside the ROI's margin without the head's motion.
    const Pose T_world_camera = turned(0, 0.07 * i, 0, {0.025 * i, 0, 0});
    const FrameBuffer buffer =
        rendered_frame(camera, small_tool(), T_world_camera.inverse() * T_world_pen);
    const BaselineResult result =
        tracker.process(buffer.view(Time{i * 33'000'000}, {}, 0), head_at(T_world_camera));
    ASSERT_EQ(result.reason, Reason::none) << i;
    EXPECT_EQ(result.from_roi, i > 0) << i;
  }
}

TEST(Seed, GoesOnBetweenFramesAtConstantVelocity) {
  const Camera camera = hololens1_short_throw();
  const Tool tool = small_tool();
  BaselineTracker tracker(camera, tool);
  EXPECT_EQ(tracker.pose_at({}).reason, Reason::no_frame_yet);
  const auto at = [&](double step) {
    return turned(0.4, -0.3, 1.1 + 0.1 * step, {0.05 + 0.01 * step, -0.02, 0.45});
  };
  for (int i = 1; i <= 2; ++i) {
    const FrameBuffer buffer = rendered_frame(camera, tool, at(i));
    (void)tracker.process(buffer.view(Time{i * 30'000'000}, {}, 0), no_head());
  }
  for (const double step : {1.5, 2.0, 2.5}) {
    const auto time = Time{static_cast<std::int64_t>(step * 30'000'000)};
    const Result<Pose> pose = tracker.pose_at(time);
    ASSERT_TRUE(pose) << step;
    EXPECT_NEAR(pose.value.translation.x(), at(step).translation.x(), 0.002) << step;
    EXPECT_LT(pose.value.rotation.angularDistance(at(step).rotation), 1.5 * k_radians_per_degree)
        << step;
  }
  EXPECT_EQ(tracker.pose_at(Time{400'000'000}).reason, Reason::too_old);
}

TEST(Seed, RefusesFramesThatAreLateOrOfAnotherSize) {
  const Camera camera = hololens1_short_throw();
  BaselineTracker tracker(camera, small_tool());
  const FrameBuffer buffer = rendered_frame(camera, small_tool(), k_pose);
  (void)tracker.process(buffer.view(Time{50}, {}, 0), no_head());
  EXPECT_EQ(tracker.process(buffer.view(Time{50}, {}, 0), no_head()).reason, Reason::frame_late);
  FrameBuffer small = buffer;
  small.height = 100;
  EXPECT_EQ(tracker.process(small.view(Time{60}, {}, 0), no_head()).reason, Reason::frame_invalid);
  FrameBuffer flat = buffer;
  flat.depth.clear();
  EXPECT_EQ(tracker.process(flat.view(Time{60}, {}, 0), no_head()).reason, Reason::frame_invalid);
}

TEST(Seed, SeesNothingInADarkFrame) {
  const Camera camera = hololens1_short_throw();
  Tool none = small_tool();
  none.marker_count = 0;
  const FrameBuffer buffer = rendered_frame(camera, none, k_pose);
  BaselineTracker tracker(camera, small_tool());
  EXPECT_EQ(tracker.process(buffer.view({}, {}, 0), no_head()).reason, Reason::too_few_markers);
}

TEST(Seed, TakesTheRimsDepthWhereASaturatedMiddleHasNone) {
  const Camera camera = hololens1_short_throw();
  FrameBuffer buffer = rendered_frame(camera, small_tool(), k_pose);
  for (std::size_t i = 0; i < buffer.depth.size(); ++i)
    if (buffer.reflectivity_8[i] == 255) buffer.depth[i] = 0;
  BaselineTracker tracker(camera, small_tool());
  const BaselineResult result = tracker.process(buffer.view({}, {}, 0), no_head());
  ASSERT_EQ(result.reason, Reason::none);
  // The rim is up to a radius behind the nearest surface point.
  EXPECT_LT((result.T_camera_tool.translation - k_pose.translation).norm(), 0.006);
}

}  // namespace
}  // namespace glint::baseline_tracker_test
