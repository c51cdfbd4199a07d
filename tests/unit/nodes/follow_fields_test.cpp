// Node FollowMotion: covariances, slices and output fields of the tracked tools after one frame.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "kernels/pose/lever_arm.hpp"
#include "nodes/follow_motion.hpp"
#include "tests/unit/kernels/motion/motion_scene.hpp"

namespace glint::follow_fields_test {
namespace {

// Six tools. Partition 1 of 4 processes tools 1 and 5.
class FollowFields : public testing::Test {
 protected:
  using Followed = graph::Parts<FollowedTools, k_tool_partitions>;

  FollowFields() {
    set_->count = 6;
    for (std::size_t t = 0; t < 6; ++t) {
      Tool& tool = set_->items[t];
      tool.marker_count = 3;
      tool.markers_m = {Vector3(0, 0, 0.1), Vector3(0.06, 0, 0.1), Vector3(0, 0.06, 0.16)};
      tool.tip_m = tool.middle_m();  // so that the covariance is that of the markers' mean
      tool.identity = static_cast<std::uint32_t>(30 + t);
      FittedTool& fit = (*fitted_)[static_cast<int>(t) % k_tool_partitions].tools[t];
      fit.reason = Reason::none;
      fit.T_camera_tool = {random_.rotation(), Vector3(0.1 * static_cast<double>(t), 0, 0.5)};
      fit.covariance = test::random_covariance<6>(random_, 0.0004);
    }
    anchor_.now.head.valid = true;
    anchor_.now.head.T_world_camera = {random_.rotation(), Vector3(1, 2, 3)};
  }
  FittedTool& fit(std::size_t tool) { return (*fitted_)[1].tools[tool]; }
  const TrackedTool& frame(std::int64_t ms, std::size_t place = 0) {
    verdict_.stamp.mid_exposure = Time{} + milliseconds(ms);
    graph::Latest<ToolSet> tools;
    tools.set(*set_, 1, 0);
    (*last_)[1] = *followed_;
    node_(verdict_, anchor_, tools, *fitted_, *few_, graph::Previous<Followed>(*last_),
          {1, k_tool_partitions}, *followed_);
    return followed_->items[place];
  }
  static Matrix6 pose_covariance(const MotionState& state) {
    Matrix6 out;
    constexpr int k_place[] = {k_position, k_rotation};
    for (int i = 0; i < 2; ++i) {
      for (int j = 0; j < 2; ++j) {
        out.block<3, 3>(3 * i, 3 * j) = state.covariance.block<3, 3>(k_place[i], k_place[j]);
      }
    }
    return out;
  }

  test::Random random_{3};
  std::unique_ptr<ToolSet> set_ = std::make_unique<ToolSet>();
  FrameVerdict verdict_;
  Anchor anchor_;
  std::unique_ptr<graph::Parts<FittedTools, k_tool_partitions>> fitted_ =
      std::make_unique<graph::Parts<FittedTools, k_tool_partitions>>();
  std::unique_ptr<SeenFew> few_ = std::make_unique<SeenFew>();
  std::unique_ptr<Followed> last_ = std::make_unique<Followed>();
  std::unique_ptr<FollowedTools> followed_ = std::make_unique<FollowedTools>();
  glint::FollowMotion node_;
};

TEST_F(FollowFields, OfASliceAreItsToolsInOrder) {
  (void)frame(22);
  for (const std::size_t place : {0U, 1U}) {
    const std::size_t t = 1 + 4 * place;
    const TrackedTool& tool = followed_->items[place];
    EXPECT_EQ(tool.identity, 30 + t);
    EXPECT_TRUE(tool.in_use);
    EXPECT_EQ(tool.reason, Reason::none);
    EXPECT_EQ(tool.base, ReferenceFrame::world);
    const Pose middle = anchor_.now.head.T_world_camera * fit(t).T_camera_tool;
    EXPECT_LT((tool.estimate.pose.translation - middle * set_->items[t].middle_m()).norm(), 1e-12);
    EXPECT_EQ(tool.estimate.time, Time{} + milliseconds(22));
  }
  EXPECT_EQ(node_.counts()[0], 1);
  EXPECT_EQ(node_.counts()[1], 2);
  EXPECT_EQ(node_.counts()[2], 2);
}

// Clears the fields of removed tools, once.
TEST_F(FollowFields, BeyondTheSlicesToolsAreAsTheyWereMade) {
  (void)frame(22);
  set_->count = 2;
  (void)frame(44);
  EXPECT_TRUE(followed_->items[0].in_use);
  EXPECT_FALSE(followed_->items[1].in_use);
  EXPECT_EQ(followed_->items[1].identity, 0U);
  EXPECT_FALSE(followed_->items[1].motion.known());
  EXPECT_EQ(node_.counts()[1], 1);
  node_.limits.tools = 1;
  (void)frame(66);
  EXPECT_FALSE(followed_->items[0].in_use);
  EXPECT_EQ(node_.counts(), (graph::LoopCounts{{1}}));
}

// After the first pose: its covariance, rotated into the world, plus the head's fresh error.
TEST_F(FollowFields, OfAFirstPoseAreItsCovarianceTurnedAndTheHeadsFreshError) {
  anchor_.now.independent = test::random_covariance<6>(random_, 0.0003);
  anchor_.now.pivot_m = Vector3(2, 2, 2);
  const Pose& head = anchor_.now.head.T_world_camera;
  const TrackedTool& tool = frame(22);
  const Vector3 place = head * (fit(1).T_camera_tool * set_->items[1].middle_m());
  const Matrix6 lever = pose_by_pose(place - anchor_.now.pivot_m);
  const Matrix6 expected = rotated_covariance(fit(1).covariance, head.rotation) +
                           lever * anchor_.now.independent * lever.transpose();
  EXPECT_LT((pose_covariance(tool.estimate) - expected).norm(), 1e-12);
  *followed_ = {};
  anchor_.now.head.valid = false;
  const TrackedTool& camera = frame(22);
  EXPECT_EQ(camera.base, ReferenceFrame::camera);
  EXPECT_LT((pose_covariance(camera.estimate) - fit(1).covariance).norm(), 1e-15);
}

TEST_F(FollowFields, OfErrorsThatPosesShareAreTurnedIntoTheWorld) {
  fit(1).systematic.correlated.fast = test::random_covariance<6>(random_, 0.001);
  fit(1).systematic.correlated.slow = test::random_covariance<6>(random_, 0.002);
  const Matrix6 sum = fit(1).systematic.correlated.sum();
  const Quaternion& turn = anchor_.now.head.T_world_camera.rotation;
  EXPECT_LT((frame(22).correlated_covariance - rotated_covariance(sum, turn)).norm(), 1e-12);
  *followed_ = {};
  anchor_.now.head.valid = false;
  EXPECT_LT((frame(22).correlated_covariance - sum).norm(), 1e-12);
}

// Publishes the filter's pose where the markers alone leave a rotation undetermined: for each axis,
// at the limit and just above it.
TEST_F(FollowFields, AreTheFiltersWhereTheMarkersAloneLeaveATurnOpen) {
  const double limit = node_.precision_limits.rotation_rad * node_.precision_limits.rotation_rad;
  int number = 0;
  for (int axis = 3; axis < 6; ++axis) {
    for (const double share : {1.0, 1.001}) {
      fit(1).covariance = Matrix6::Identity() * 1e-8;
      fit(1).covariance(axis, axis) = share * limit;
      EXPECT_EQ(frame(22 * ++number).use_filter_pose, share > 1) << axis;
      EXPECT_EQ(followed_->items[1].use_filter_pose, false);
    }
  }
}

// The markers' own pose and the one near the prediction are two minima of one fit.
TEST_F(FollowFields, AreTheFiltersWhereTheMarkersAloneFitAnotherPose) {
  fit(1).covariance = fit(1).relinearised_covariance = Matrix6::Identity() * 1e-8;
  fit(1).relinearised_T_camera_tool = fit(1).T_camera_tool;
  fit(1).has_relinearised = true;
  EXPECT_FALSE(frame(22).use_filter_pose);
  const Quaternion turn = from_rotation_vector(Vector3(0.2, 0, 0));
  fit(1).T_camera_tool.rotation = turn * fit(1).T_camera_tool.rotation;
  EXPECT_TRUE(frame(44).use_filter_pose);
  fit(1).has_relinearised = false;
  EXPECT_FALSE(frame(66).use_filter_pose);
}

// One visible marker of a tracked tool, in its base frame.
class FollowFew : public FollowFields {
 protected:
  void track_tool() {
    for (int i = 1; i <= 5; ++i) (void)frame(22 * i);
    fit(1).reason = Reason::no_labeling;
    few_->tools[1].count = 1;
    few_->tools[1].items[0] = {2, fit(1).T_camera_tool * set_->items[1].markers_m[2],
                               Matrix3::Identity() * 1e-8};
  }
  [[nodiscard]] double place_variance(const TrackedTool& tool) const {
    return pose_covariance(tool.estimate).topLeftCorner<3, 3>().trace();
  }
};

TEST_F(FollowFew, MovesOnItsMotionItsNoiseAndItsMask) {
  for (const bool head : {true, false}) {
    *followed_ = {};
    fit(1).reason = Reason::none;
    anchor_.now.head.valid = head;
    track_tool();
    const MotionState before = followed_->items[0].estimate;
    const TrackedTool& tool = frame(132);
    EXPECT_EQ(tool.partial_mask, 0b100);
    EXPECT_EQ(tool.reason, Reason::no_labeling);
    EXPECT_EQ(tool.estimate.time, Time{} + milliseconds(132));
    EXPECT_LT((tool.estimate.pose.translation - before.pose.translation).norm(), 0.002);
    const NoiseScale noise = tool.motion.partial_visibility_noise_scale(node_.settings);
    EXPECT_EQ(tool.noise.linear, noise.linear);
    EXPECT_EQ(tool.noise.angular, noise.angular);
    EXPECT_EQ(node_.counts(), (graph::LoopCounts{{1, 2, 2, node_.counts()[3]}}));
    EXPECT_EQ(followed_->items[1].partial_mask, 0);
  }
}

TEST_F(FollowFew, IsLessSureWhereTheHeadOrTheMarkerIs) {
  track_tool();
  const FollowedTools known = *followed_;
  const double sure = place_variance(frame(132));
  *followed_ = known;
  anchor_.now.independent.diagonal().head<3>().setConstant(1e-4);
  const double by_head = place_variance(frame(132));
  EXPECT_GT(by_head, 2 * sure);
  *followed_ = known;
  anchor_.now.independent.setZero();
  few_->tools[1].items[0].covariance_m2 = Matrix3::Identity() * 1e-4;
  EXPECT_NEAR(place_variance(frame(132)), by_head, 0.3 * by_head);
}

// Along the camera's axis the marker's variance is large, so the tool's stays large along it.
TEST_F(FollowFew, TurnsAMarkersCovarianceIntoTheWorld) {
  track_tool();
  few_->tools[1].items[0].covariance_m2 = Vector3(1e-8, 1e-8, 1).asDiagonal();
  const TrackedTool& tool = frame(132);
  const Quaternion& turn = anchor_.now.head.T_world_camera.rotation;
  const Matrix3 place = pose_covariance(tool.estimate).topLeftCorner<3, 3>();
  const auto variance = [&](const Vector3& axis) {
    const Vector3 in_world = turn * axis;
    return in_world.dot(place * in_world);
  };
  EXPECT_GT(variance(Vector3::UnitZ()), 2 * variance(Vector3::UnitX()));
  EXPECT_GT(variance(Vector3::UnitZ()), 2 * variance(Vector3::UnitY()));
}

// In the camera frame a correction of the world does not move the tool.
TEST_F(FollowFields, InTheCamerasFrameStayWhereTheWorldMoves) {
  for (const bool head : {false, true}) {
    *followed_ = {};
    anchor_.now = {};
    anchor_.now.head.valid = head;
    (void)frame(22);
    const Vector3 before = followed_->items[0].motion.place();
    anchor_.now.gap_correction.translation = {0.5, 0, 0};
    anchor_.now.moved_along = true;
    fit(1).reason = Reason::no_labeling;
    const Vector3 moved = frame(44).motion.place() - before;
    EXPECT_NEAR(moved.x(), head ? 0.5 : 0, 1e-12);
    fit(1).reason = Reason::none;
  }
}

}  // namespace
}  // namespace glint::follow_fields_test
