// Node TrackTools: every field of a track after a pose, with partial visibility and without
// markers, each with a different value.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "kernels/pose/lever_arm.hpp"
#include "nodes/track_tools.hpp"
#include "tests/unit/kernels/motion/motion_scene.hpp"

namespace glint::track_fields_test {
namespace {

// Tool 5 of six, which is tool 1 of slice 1, with a known head pose.
class TrackFields : public testing::Test {
 protected:
  static constexpr std::size_t k_tool = 5;

  TrackFields() {
    set_->count = 6;
    for (std::size_t t = 0; t < 6; ++t) {
      Tool& tool = set_->items[t];
      tool.marker_count = 3;
      tool.markers_m = {Vector3(0, 0, 0.1), Vector3(0.06, 0, 0.1), Vector3(0, 0.06, 0.16)};
      tool.tip_m = Vector3(0.01, 0.02, -0.03);
      tool.tip_sigma_m = 0.001 * static_cast<double>(t);
      tool.identity = static_cast<std::uint32_t>(50 + t);
    }
    anchor_.now.head.valid = true;
    anchor_.now.head.T_world_camera = {random_.rotation(), Vector3(1, 2, 3)};
    anchor_.now.shared = test::random_covariance<6>(random_, 0.01);
    anchor_.now.pivot_m = Vector3(3, 2, 1);
    FittedTool& fit = found();
    fit.reason = Reason::none;
    fit.T_camera_tool = {random_.rotation(), Vector3(0.1, -0.2, 0.6)};
    fit.marker_mask = 0b101;
    fit.rms_m = 0.0007;
    fit.odds = 23;
    TrackedTool& follow = followed();
    follow.reason = Reason::none;
    follow.is_publishable = true;
    follow.base = ReferenceFrame::world;
    follow.estimate = test::random_state(random_);
    follow.noise = {1.25, 2.5};
    follow.partial_mask = 0;
    // The second pose's rotation differs from the prediction; the size of the difference is
    // irrelevant. A position that differs would enlarge the covariance.
    const ToolMotionSettings settings;
    StaticWindowSums sums;
    UncertainPose seen;
    seen.covariance = Matrix6::Identity() * 1e-8;
    EXPECT_EQ(follow.motion.update(seen, {}, settings, sums).reason, Reason::none);
    seen.time = Time{} + milliseconds(22);
    seen.pose.rotation = from_rotation_vector(Vector3(0.5, 0, 0));
    EXPECT_EQ(follow.motion.update(seen, {}, settings, sums).reason, Reason::none);
  }
  FittedTool& found() { return (*fitted_)[1].tools[k_tool]; }
  TrackedTool& followed() { return (*followed_)[1].items[1]; }
  [[nodiscard]] double chi_square() { return followed().motion.last_correction().nis; }
  const Track& frame(std::int64_t ms) {
    verdict_.stamp.mid_exposure = Time{} + milliseconds(ms);
    verdict_.stamp.sequence = static_cast<std::uint64_t>(7 * ms);
    verdict_.stamp.sigma = Duration{ms + 1};
    graph::Latest<ToolSet> tools;
    tools.set(*set_, 1, 0);
    *last_ = *out_;
    node_(verdict_, anchor_, tools, *fitted_, *followed_, graph::Previous<Estimates>(*last_),
          *out_);
    return out_->tracks[k_tool];
  }
  // A frame with one or two visible markers.
  const Track& partial_frame(std::int64_t ms, bool is_publishable) {
    followed().reason = found().reason = Reason::too_few_markers;
    followed().partial_mask = 0b10;
    followed().is_publishable = is_publishable;
    return frame(ms);
  }

  test::Random random_{11};
  std::unique_ptr<ToolSet> set_ = std::make_unique<ToolSet>();
  Anchor anchor_;
  FrameVerdict verdict_;
  std::unique_ptr<graph::Parts<FittedTools, k_tool_partitions>> fitted_ =
      std::make_unique<graph::Parts<FittedTools, k_tool_partitions>>();
  std::unique_ptr<graph::Parts<FollowedTools, k_tool_partitions>> followed_ =
      std::make_unique<graph::Parts<FollowedTools, k_tool_partitions>>();
  std::unique_ptr<Estimates> last_ = std::make_unique<Estimates>(),
                             out_ = std::make_unique<Estimates>();
  glint::TrackTools node_;
};

double distance(const Pose& a, const Pose& b) {
  return (a.translation - b.translation).norm() +
         rotation_vector(a.rotation * b.rotation.conjugate()).norm();
}

TEST_F(TrackFields, AreOfThePoseItsFrameAndItsMotion) {
  const Track track = frame(22);
  EXPECT_TRUE(track.alive && track.measured_now);
  EXPECT_FALSE(track.unconfirmed || track.is_filter_pose || track.has_previous);
  EXPECT_EQ(track.reason, Reason::none);
  EXPECT_EQ(track.base, ReferenceFrame::world);
  EXPECT_EQ(track.marker_mask, 0b101);
  EXPECT_EQ(track.frame_sequence, 154U);
  EXPECT_EQ(track.stamp_sigma.nanoseconds, 23);
  EXPECT_EQ(track.identity, 55U);
  EXPECT_EQ(track.rms_m, 0.0007);
  EXPECT_EQ(track.odds, 23);
  EXPECT_EQ(track.newest.time, Time{} + milliseconds(22));
  const Pose& head = anchor_.now.head.T_world_camera;
  EXPECT_LT(distance(track.newest.pose, head * found().T_camera_tool), 1e-12);
  EXPECT_LT(distance(track.T_camera_tool, found().T_camera_tool), 1e-12);
  EXPECT_EQ(track.motion.pose.translation, followed().estimate.pose.translation);
  EXPECT_EQ(track.motion.covariance, followed().estimate.covariance);
  EXPECT_EQ(track.noise.linear, 1.25);
  EXPECT_EQ(track.noise.angular, 2.5);
  ASSERT_GT(chi_square(), 12);
  EXPECT_DOUBLE_EQ(track.nis_ratio, chi_square() / 6);
  EXPECT_EQ(track.head_covariance, anchor_.now.shared_at(followed().estimate.pose.translation));
  EXPECT_EQ(node_.counts(), (graph::LoopCounts{{1, 6, 1}}));
}

TEST_F(TrackFields, OfAPoseInTheCamerasFrameAreTheCameras) {
  anchor_.now.head.valid = false;
  followed().base = ReferenceFrame::camera;
  const Track track = frame(22);
  EXPECT_EQ(track.base, ReferenceFrame::camera);
  EXPECT_EQ(track.newest.pose.translation, found().T_camera_tool.translation);
  EXPECT_EQ(track.T_camera_tool.translation, found().T_camera_tool.translation);
  EXPECT_TRUE(track.head_covariance.isZero());
}

// The published NIS over its dimension is at least 1.
TEST_F(TrackFields, OfAnExpectedPoseHaveNoSurprise) {
  followed().motion = MotionTrack{};
  EXPECT_EQ(frame(22).nis_ratio, 1);
}

// The previous pose, if recent and of the same base: at the limit and just above it.
TEST_F(TrackFields, OfThePoseBeforeAreThereWhileItIsRecentAndOfTheSameBase) {
  node_.settings.velocity_gap_max = milliseconds(40);
  for (const std::int64_t gap : {40, 41}) {
    *out_ = {};
    const Pose before = frame(100).newest.pose;
    found().T_camera_tool.translation.x() += 0.01;
    const Track track = frame(100 + gap);
    EXPECT_EQ(track.has_previous, gap == 40);
    EXPECT_EQ(track.previous.time, Time{} + milliseconds(100));
    EXPECT_EQ(track.previous.pose.translation, before.translation);
    EXPECT_GT(distance(track.newest.pose, before), 0.009);
  }
  anchor_.now.head.valid = false;
  EXPECT_FALSE(frame(150).has_previous) << "in another base";
  EXPECT_TRUE(frame(160).has_previous);
  *out_ = {};
  EXPECT_FALSE(frame(170).has_previous) << "there was none";
}

TEST_F(TrackFields, OfFewMarkersAreTheFiltersAndKeepWhatThreeGave) {
  const Track before = frame(22);
  followed().estimate = test::random_state(random_);
  followed().noise = {3.5, 4.5};
  const Track track = partial_frame(44, true);
  const Pose of_tool = {followed().estimate.pose.rotation,
                        followed().estimate.pose * Vector3(-set_->items[k_tool].middle_m())};
  EXPECT_LT(distance(track.newest.pose, of_tool), 1e-12);
  EXPECT_LT(distance(track.T_camera_tool, anchor_.now.head.T_world_camera.inverse() * of_tool),
            1e-12);
  EXPECT_EQ(track.newest.time, Time{} + milliseconds(44));
  EXPECT_TRUE(track.is_filter_pose && track.alive);
  EXPECT_FALSE(track.has_previous || track.measured_now);
  EXPECT_EQ(track.marker_mask, 0b10);
  EXPECT_EQ(track.frame_sequence, 308U);
  EXPECT_EQ(track.stamp_sigma.nanoseconds, 45);
  EXPECT_EQ(track.rms_m, before.rms_m);
  EXPECT_EQ(track.odds, before.odds);
  EXPECT_EQ(track.noise.angular, 4.5);
  EXPECT_EQ(track.motion.covariance, followed().estimate.covariance);
  EXPECT_DOUBLE_EQ(track.nis_ratio, chi_square() / 3) << "of a point's three numbers";
  EXPECT_EQ(track.head_covariance, anchor_.now.shared_at(followed().estimate.pose.translation));
  // In the camera frame the head adds no covariance.
  *out_ = {};
  anchor_.now.head.valid = false;
  followed().base = ReferenceFrame::camera;
  followed().reason = found().reason = Reason::none;
  (void)frame(22);
  const Track camera = partial_frame(44, true);
  EXPECT_LT(distance(camera.T_camera_tool, of_tool), 1e-12);
  EXPECT_TRUE(camera.head_covariance.isZero());
}

TEST_F(TrackFields, OfFewMarkersThatAreUnsureMoveOnTheMotionAlone) {
  const Track before = frame(22);
  followed().estimate = test::random_state(random_);
  followed().correlated_covariance(3, 3) = 8e-6;
  const Track track = partial_frame(44, false);
  EXPECT_EQ(track.motion.pose.translation, followed().estimate.pose.translation);
  EXPECT_EQ(track.correlated_covariance(3, 3), 8e-6);
  EXPECT_EQ(track.newest.time, before.newest.time);
  EXPECT_EQ(track.frame_sequence, before.frame_sequence);
  EXPECT_EQ(track.marker_mask, before.marker_mask);
  EXPECT_EQ(track.head_covariance, before.head_covariance);
}

TEST_F(TrackFields, GoFurtherThanTheLimitNoMore) {
  node_.settings.lost_after = milliseconds(40);
  (void)frame(100);
  followed().reason = found().reason = Reason::no_labeling;
  EXPECT_TRUE(frame(140).alive);
  EXPECT_EQ(out_->tracks[k_tool].reason, Reason::no_labeling);
  const Track lost = frame(141);
  EXPECT_FALSE(lost.alive || lost.measured_now);
  EXPECT_EQ(lost.reason, Reason::no_labeling) << "why it is lost";
  EXPECT_EQ(lost.identity, 55U);
  EXPECT_EQ(lost.newest.time, Time{});
}

// A correction of the world frame moves the fields in it; those of the camera stay.
TEST_F(TrackFields, MoveAlongWithTheWorld) {
  (void)frame(22);
  const Track before = frame(44);
  anchor_.now.gap_correction = {from_rotation_vector(Vector3(0.1, 0.2, -0.1)),
                                Vector3(0.3, 0.1, 0.2)};
  anchor_.now.moved_along = true;
  followed().reason = found().reason = Reason::no_labeling;
  const Track moved = frame(66);
  EXPECT_LT(distance(moved.newest.pose, anchor_.now.gap_correction * before.newest.pose), 1e-12);
  EXPECT_LT(distance(moved.previous.pose, anchor_.now.gap_correction * before.previous.pose),
            1e-12);
  EXPECT_LT(distance(moved.motion.pose, anchor_.now.gap_correction * before.motion.pose), 1e-12);
  EXPECT_LT(
      (moved.motion.velocity_m_s - anchor_.now.gap_correction.rotation * before.motion.velocity_m_s)
          .norm(),
      1e-12);
  out_->tracks[k_tool] = before;
  out_->tracks[k_tool].base = ReferenceFrame::camera;
  EXPECT_EQ(frame(66).newest.pose.translation, before.newest.pose.translation);
  out_->tracks[k_tool] = before;
  anchor_.now.moved_along = false;
  EXPECT_EQ(frame(66).newest.pose.translation, before.newest.pose.translation);
}

TEST_F(TrackFields, OfTheFrameAreItsVerdictTipsAndReference) {
  anchor_.T_world_reference = {random_.rotation(), Vector3(7, 8, 9)};
  verdict_.accepted = 77;
  (void)frame(22);
  EXPECT_EQ(out_->tool_count, 6);
  EXPECT_EQ(out_->verdict.accepted, 77U);
  EXPECT_EQ(out_->verdict.stamp.sequence, 154U);
  EXPECT_EQ(out_->T_world_reference.translation, Vector3(7, 8, 9));
  EXPECT_FALSE(out_->has_reference);
  for (std::size_t t = 0; t < 6; ++t) {
    const Tool& tool = set_->items[t];
    EXPECT_EQ(out_->tips[t].arm_m, Vector3(tool.tip_m - tool.middle_m()));
    EXPECT_EQ(out_->tips[t].sigma_m, tool.tip_sigma_m);
  }
  HeadPose head;
  head.valid = true;
  const UncertainPose body{head.time, {}, Matrix6::Identity() * 1e-8};
  (void)anchor_.state.update(head, &body, {});
  (void)frame(44);
  EXPECT_TRUE(out_->has_reference);
}

TEST_F(TrackFields, BeyondTheToolsAreCleared) {
  ASSERT_TRUE(frame(22).alive);
  set_->count = 5;
  const Track& beyond = frame(44);
  EXPECT_EQ(out_->tool_count, 5);
  EXPECT_FALSE(beyond.alive);
  EXPECT_EQ(beyond.identity, 0U);
  EXPECT_TRUE(out_->tips[k_tool].arm_m.isZero());
  EXPECT_EQ(node_.counts(), (graph::LoopCounts{{1, 5, 0}}));
  set_->count = 6;
  node_.limits.tools = 4;
  (void)frame(66);
  EXPECT_EQ(out_->tool_count, 4);
}

// Reference: the full Jacobian of rotation and lever arm. The kernels skip its ones and zeros.
TEST_F(TrackFields, GiveTheTipsCovarianceAboutTheCamerasAxes) {
  Track track = frame(22);
  FittedTool fit = found();
  fit.covariance = test::random_covariance<6>(random_, 0.002);
  fit.systematic.calibration = test::random_covariance<6>(random_, 0.003);
  fit.systematic.correlated.fast = test::random_covariance<6>(random_, 0.001);
  fit.systematic.correlated.slow = test::random_covariance<6>(random_, 0.002);
  const TipPosition tip{Vector3(0.02, -0.1, 0.05), 0.004};
  const Matrix6 lever = pose_by_pose(track.T_camera_tool.rotation * tip.arm_m);
  Matrix6 systematic = lever *
                       (fit.systematic.calibration + fit.systematic.correlated.fast +
                        fit.systematic.correlated.slow) *
                       lever.transpose();
  systematic.diagonal().head<3>().array() += 0.004 * 0.004;
  EXPECT_LT((tip_covariance(track, fit, tip) - fit.covariance - systematic).norm(), 1e-15);
  track.is_filter_pose = true;
  Matrix6 of_motion;
  const int place[] = {k_position, k_position + 1, k_position + 2,
                       k_rotation, k_rotation + 1, k_rotation + 2};
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) of_motion(i, j) = track.motion.covariance(place[i], place[j]);
  }
  const Matrix3 camera_world =
      anchor_.now.head.T_world_camera.rotation.conjugate().toRotationMatrix();
  Matrix6 turn = Matrix6::Zero();
  turn.topLeftCorner<3, 3>() = turn.bottomRightCorner<3, 3>() = camera_world;
  const Matrix6 expected = lever * turn * of_motion * turn.transpose() * lever.transpose();
  EXPECT_LT((tip_covariance(track, fit, tip) - expected - systematic).norm(), 1e-12);
}

}  // namespace
}  // namespace glint::track_fields_test
