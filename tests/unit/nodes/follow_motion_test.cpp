#include "nodes/follow_motion.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "tests/unit/kernels/motion/motion_scene.hpp"

namespace glint {
namespace {

constexpr double k_shift_sigma = 0.0005, k_turn_sigma = 0.004;

class FollowMotion : public testing::Test {
 protected:
  using Followed = graph::Parts<FollowedTools, k_tool_partitions>;

  FollowMotion() {
    Tool& tool = set_->items[0];
    tool.marker_count = 3;
    tool.markers_m = {Vector3(0, 0, 0.1), Vector3(0.06, 0, 0.1), Vector3(0, 0.06, 0.16)};
    set_->count = 1;
    tools_.set(*set_, 1, 0);
    anchor_.now.head.valid = true;
    anchor_.now.head.T_world_camera = {random_.rotation(), Vector3(1, 2, 3)};
    T_camera_tool_ = {random_.rotation(), Vector3(0, 0, 0.5)};
  }
  // Runs one frame. Its output becomes the next frame's previous output.
  void frame(bool found = true) {
    *followed_ = tried(found);
    (*last_)[0] = *followed_;
    ++number_;
  }
  FollowedTools tried(bool found = true, const Vector3& aside = Vector3::Zero()) {
    FrameVerdict verdict;
    verdict.reason = refused_ ? Reason::frame_late : Reason::none;
    verdict.resynchronised = restarted_;
    verdict.stamp.mid_exposure = Time{} + milliseconds(22) * number_;
    FittedTool& tool = (*fitted_)[0].tools[0];
    tool.reason = found ? Reason::none : Reason::no_labeling;
    const UncertainPose seen =
        test::measured_pose(T_camera_tool_, {}, shift_sigma_m_, turn_sigma_rad_, random_);
    tool.T_camera_tool = {seen.pose.rotation, seen.pose.translation + aside};
    tool.covariance = seen.covariance;
    FollowedTools out;
    node_(verdict, anchor_, tools_, *fitted_, few_, graph::Previous<Followed>(*last_),
          {0, k_tool_partitions}, out);
    return out;
  }
  const TrackedTool& tool() { return followed_->items[0]; }

  test::Random random_{1};
  std::unique_ptr<ToolSet> set_ = std::make_unique<ToolSet>();
  graph::Latest<ToolSet> tools_;
  Anchor anchor_;
  Pose T_camera_tool_;
  bool refused_ = false, restarted_ = false;
  int number_ = 1;
  double shift_sigma_m_ = k_shift_sigma, turn_sigma_rad_ = k_turn_sigma;
  std::unique_ptr<graph::Parts<FittedTools, k_tool_partitions>> fitted_ =
      std::make_unique<graph::Parts<FittedTools, k_tool_partitions>>();
  SeenFew few_;
  std::unique_ptr<Followed> last_ = std::make_unique<Followed>();
  std::unique_ptr<FollowedTools> followed_ = std::make_unique<FollowedTools>();
  glint::FollowMotion node_;
};

TEST_F(FollowMotion, KnowsARestingToolsMiddleInTheWorldBetterThanOneFrameCan) {
  for (int i = 0; i < 90; ++i) frame();
  const Pose T_world_tool = anchor_.now.head.T_world_camera * T_camera_tool_;
  const Vector3 middle = T_world_tool * set_->items[0].middle_m();
  EXPECT_TRUE(tool().motion.is_static());
  EXPECT_LT((tool().estimate.pose.translation - middle).norm(), 0.0003);
  EXPECT_LT(test::angle_between(tool().estimate.pose.rotation, T_world_tool.rotation), 0.002);
  EXPECT_LT(tool().estimate.covariance(0, 0), 0.1 * k_shift_sigma * k_shift_sigma);
}

TEST_F(FollowMotion, CountsItsToolsThoseItMovedAndTheirRestTests) {
  frame(false);
  EXPECT_EQ(node_.counts(), (graph::LoopCounts{{1, 1}}));
  for (int i = 0; i < 90; ++i) frame();
  EXPECT_EQ(node_.counts()[1], 1);
  EXPECT_EQ(node_.counts()[2], 1);
  EXPECT_GT(node_.counts()[3], 0);
}

TEST_F(FollowMotion, FollowsAToolThatMoves) {
  for (int i = 0; i < 60; ++i) {
    T_camera_tool_.translation.x() = -0.2 + 0.3 * 0.022 * i;
    frame();
  }
  const Vector3 velocity = anchor_.now.head.T_world_camera.rotation * Vector3(0.3, 0, 0);
  EXPECT_LT((tool().estimate.velocity_m_s - velocity).norm(), 0.1);
  EXPECT_NE(tool().noise.linear, NoiseScale{}.linear);
  EXPECT_EQ(tool().noise.linear, tool().motion.noise_scale().linear);
  EXPECT_EQ(tool().noise.angular, tool().motion.noise_scale().angular);
}

TEST_F(FollowMotion, IsAsIfAnAbandonedFrameHadNeverBeen) {
  for (int i = 0; i < 200; ++i) {
    const Vector3 aside = i % 2 == 0 ? Vector3(0.5, 0, 0) : Vector3(0, 0.004, 0);
    if (number_ > 1) (void)tried(true, aside);
    frame();
  }
  EXPECT_TRUE(tool().motion.is_static()) << "the steps aside ended no rest";
  const Pose T_world_tool = anchor_.now.head.T_world_camera * T_camera_tool_;
  const Vector3 middle = T_world_tool * set_->items[0].middle_m();
  EXPECT_LT((tool().estimate.pose.translation - middle).norm(), 0.0003);
}

TEST_F(FollowMotion, LeavesWhatItKnowsWhereAFrameIsRefusedOrShowsNothing) {
  for (int i = 0; i < 20; ++i) frame();
  const MotionState before = tool().estimate;
  refused_ = true;
  frame();
  EXPECT_EQ(tool().reason, Reason::frame_late);
  EXPECT_EQ(tool().estimate.pose.translation, before.pose.translation);
  refused_ = false;
  frame(false);
  EXPECT_EQ(tool().reason, Reason::no_labeling);
  EXPECT_EQ(tool().estimate.time, before.time);
  frame();
  EXPECT_EQ(tool().reason, Reason::none);
  EXPECT_GT(tool().estimate.time, before.time);
}

TEST_F(FollowMotion, BeginsAnewInTheCamerasFrameWhenTheHeadsPoseGoesMissing) {
  for (int i = 0; i < 60; ++i) frame();
  anchor_.now.head.valid = false;
  frame();
  EXPECT_EQ(tool().base, ReferenceFrame::camera);
  EXPECT_FALSE(tool().motion.is_static());
  EXPECT_LT((tool().estimate.pose.translation - T_camera_tool_ * set_->items[0].middle_m()).norm(),
            0.005);
}

TEST_F(FollowMotion, GoesOnRestingWhenTheWorldIsFoundToLieElsewhere) {
  for (int i = 0; i < 60; ++i) frame();
  CorrectedHead& now = anchor_.now;
  now.gap_correction = {from_rotation_vector(Vector3(0, 0, 0.01)), Vector3(0.02, 0, 0)};
  now.moved_along = true;
  now.head.T_world_camera = now.gap_correction * now.head.T_world_camera;
  frame();
  now.moved_along = false;
  EXPECT_TRUE(tool().motion.is_static());
  const Vector3 middle = now.head.T_world_camera * T_camera_tool_ * set_->items[0].middle_m();
  EXPECT_LT((tool().estimate.pose.translation - middle).norm(), 0.0005);
}

// The reference body is hidden: the world frame may jump by centimetres a frame.
TEST_F(FollowMotion, KnowsHowSureItIsWhereTheWorldStepsBetweenFrames) {
  constexpr double k_step_m = 0.02;
  CorrectedHead& now = anchor_.now;
  double chi_square = 0, off = 0;
  constexpr int k_frames = 200;
  for (int i = 0; i < 60; ++i) frame();
  for (int i = 0; i < k_frames; ++i) {
    now.head.T_world_camera.translation += random_.vector(k_step_m);
    now.in_gap = true;
    now.step_covariance.diagonal().head<3>().setConstant(k_step_m * k_step_m);
    frame();
    const Vector3 middle = now.head.T_world_camera * T_camera_tool_ * set_->items[0].middle_m();
    const Vector3 error = tool().estimate.pose.translation - middle;
    const Matrix3 covariance = tool().estimate.covariance.topLeftCorner<3, 3>();
    chi_square += error.dot(covariance.inverse() * error) / k_frames;
    off += error.norm() / k_frames;
  }
  EXPECT_LT(off, 3 * k_shift_sigma);
  EXPECT_GT(chi_square / 3, 0.5);
  EXPECT_LT(chi_square / 3, 1.6);
}

TEST_F(FollowMotion, CountsTheHeadsFreshErrorAmongTheNoise) {
  for (int i = 0; i < 4; ++i) frame();
  const double sure = tool().estimate.covariance(0, 0);
  *last_ = {};
  anchor_.now.independent = Matrix6::Identity() * 4e-6;
  for (int i = 0; i < 4; ++i) frame();
  EXPECT_GT(tool().estimate.covariance(0, 0), 2 * sure);
}

// The tool's first `count` markers at their true positions.
void show_first_markers(const Tool& tool, const Pose& T_camera_tool, int count, SeenFew& few) {
  few.tools[0].count = count;
  for (int m = 0; m < count; ++m) {
    const auto i = static_cast<std::size_t>(m);
    few.tools[0].items[i] = {m, T_camera_tool * tool.markers_m[i], Matrix3::Identity() * 1e-7};
  }
}

TEST_F(FollowMotion, GoesOnByOneOrTwoMarkersAndSaysWhich) {
  for (int i = 0; i < 60; ++i) frame();
  for (int i = 0; i < 9; ++i) {
    T_camera_tool_.translation.x() += 0.002;
    show_first_markers(set_->items[0], T_camera_tool_, 2, few_);
    frame(false);
    EXPECT_EQ(tool().reason, Reason::no_labeling);
    EXPECT_EQ(tool().partial_mask, 0b011);
    EXPECT_EQ(tool().estimate.time, Time{} + milliseconds(22) * (number_ - 1));
  }
  const Vector3 marker =
      anchor_.now.head.T_world_camera * T_camera_tool_ * set_->items[0].markers_m[0];
  const Pose& middle = tool().estimate.pose;
  const Vector3 predicted = middle * (set_->items[0].markers_m[0] - set_->items[0].middle_m());
  EXPECT_LT((predicted - marker).norm(), 0.001);
  few_ = {};
  frame();
  EXPECT_EQ(tool().partial_mask, 0);
}

// The static window's mean does not contain the jump of the world frame since.
TEST_F(FollowMotion, GoesOnFromARestByTwoMarkersWhereTheWorldHasStepped) {
  for (int i = 0; i < 60; ++i) frame();
  ASSERT_TRUE(tool().motion.is_static());
  CorrectedHead& now = anchor_.now;
  now.head.T_world_camera.translation.x() += 0.02;
  now.in_gap = true;
  now.step_covariance.diagonal().head<3>().setConstant(4e-4);
  show_first_markers(set_->items[0], T_camera_tool_, 2, few_);
  frame(false);
  EXPECT_EQ(tool().partial_mask, 0b011);
  const Pose T_world_tool = now.head.T_world_camera * T_camera_tool_;
  const Vector3 error = tool().estimate.pose.translation - T_world_tool * set_->items[0].middle_m();
  EXPECT_LT(error.norm(), 0.001);
}

TEST_F(FollowMotion, LetsAPoseByOneMarkerStandOnlyWhileItIsSure) {
  for (int i = 0; i < 60; ++i) frame();
  show_first_markers(set_->items[0], T_camera_tool_, 1, few_);
  frame(false);
  EXPECT_TRUE(tool().is_publishable);
  int publishable_count = 1;
  for (int i = 0; i < 40; ++i) {
    frame(false);
    publishable_count += tool().is_publishable ? 1 : 0;
    const MotionCovariance& p = tool().estimate.covariance;
    double most_m = 0, most_rad = 0;
    for (int axis = 0; axis < 3; ++axis) {
      most_m = std::max(most_m, std::sqrt(p(axis, axis)));
      most_rad = std::max(most_rad, std::sqrt(p(k_rotation + axis, k_rotation + axis)));
    }
    EXPECT_EQ(tool().is_publishable, most_m <= 0.005 && most_rad <= 0.065)
        << most_m << ' ' << most_rad;
  }
  EXPECT_LT(publishable_count, 30) << "what turns about the marker shows nowhere";
  EXPECT_NE(tool().partial_mask, 0) << "it is followed all the same";
}

TEST_F(FollowMotion, LetsAPoseStandOnlyWithinBothLimits) {
  struct Case {
    double position_m, rotation_rad;
    bool is_publishable;
  };
  for (const Case& c : {Case{0.0045, 0.060, true}, Case{0.0055, 0.060, false},
                        Case{0.0045, 0.070, false}, Case{0.0055, 0.070, false}}) {
    *last_ = {};
    shift_sigma_m_ = c.position_m;
    turn_sigma_rad_ = c.rotation_rad;
    anchor_.now.head.T_world_camera.rotation.setIdentity();
    T_camera_tool_.rotation.setIdentity();
    set_->items[0].markers_m.fill(Vector3::Zero());  // mean at the origin: no lever arm
    tools_.set(*set_, 1, 0);
    frame();
    EXPECT_EQ(tool().reason, Reason::none);
    EXPECT_EQ(tool().is_publishable, c.is_publishable) << c.position_m << ' ' << c.rotation_rad;
  }
}

TEST_F(FollowMotion, LetsNoAmbiguousPoseStandHoweverSureItIs) {
  for (int i = 0; i < 20; ++i) frame();
  ASSERT_TRUE(tool().is_publishable);
  const Time before = tool().estimate.time;
  (*fitted_)[0].tools[0].odds = k_odds_min - 1;
  frame();
  EXPECT_TRUE(tool().ambiguous);
  EXPECT_FALSE(tool().is_publishable);
  EXPECT_GT(tool().estimate.time, before) << "but it is followed";
}

TEST_F(FollowMotion, BeginsAnewWhereThePoseIsNotTheOneThatWasFollowed) {
  for (int i = 0; i < 90; ++i) frame();
  ASSERT_TRUE(tool().motion.is_static());
  (*fitted_)[0].tools[0].contradicts_track = true;
  frame();
  EXPECT_FALSE(tool().motion.is_static());
  EXPECT_EQ(tool().noise.linear, NoiseScale{}.linear);
}

TEST_F(FollowMotion, LetsNoPoseOfAFrameStandInTheNext) {
  for (int i = 0; i < 9; ++i) frame();
  ASSERT_TRUE(tool().is_publishable);
  frame(false);
  EXPECT_FALSE(tool().is_publishable) << "nothing was found";
  frame();
  ASSERT_TRUE(tool().is_publishable);
  refused_ = true;
  frame();
  EXPECT_FALSE(tool().is_publishable) << "the frame was refused";
}

// The time stamps restart, either before the newest processed one or shortly after it.
TEST_F(FollowMotion, BeginsAnewWhereTheClockRestarts) {
  for (const int restarted_at : {1, 70}) {
    *last_ = {};
    number_ = 1;
    for (int i = 0; i < 60; ++i) frame();
    ASSERT_TRUE(tool().motion.is_static());
    number_ = restarted_at;
    restarted_ = true;
    T_camera_tool_.translation.x() += 0.1;
    frame();
    restarted_ = false;
    EXPECT_EQ(tool().reason, Reason::none) << restarted_at;
    EXPECT_EQ(tool().estimate.time, Time{} + milliseconds(22) * restarted_at);
    const Vector3 middle =
        anchor_.now.head.T_world_camera * T_camera_tool_ * set_->items[0].middle_m();
    EXPECT_LT((tool().estimate.pose.translation - middle).norm(), 0.005) << "not drawn to the old";
    EXPECT_TRUE(tool().estimate.velocity_m_s.isZero());
  }
}

TEST_F(FollowMotion, TakesNoMarkerForAToolThatItDoesNotKnow) {
  show_first_markers(set_->items[0], T_camera_tool_, 2, few_);
  frame(false);
  EXPECT_EQ(tool().partial_mask, 0);
  for (int i = 0; i < 9; ++i) frame();
  anchor_.now.head.valid = false;
  frame(false);
  EXPECT_EQ(tool().partial_mask, 0) << "in another frame than it was followed in";
}

TEST_F(FollowMotion, BeginsAnewWhereAnotherToolTookThePlace) {
  for (int i = 0; i < 60; ++i) frame();
  ASSERT_TRUE(tool().motion.is_static());
  set_->items[0].identity = 7;
  tools_.set(*set_, 2, 0);
  refused_ = true;
  frame();
  EXPECT_FALSE(tool().motion.known()) << "also in a frame that is refused";
  refused_ = false;
  T_camera_tool_.translation.x() += 0.1;
  frame();
  const Vector3 middle =
      anchor_.now.head.T_world_camera * T_camera_tool_ * set_->items[0].middle_m();
  EXPECT_LT((tool().estimate.pose.translation - middle).norm(), 0.005) << "not drawn to the old";
}

}  // namespace
}  // namespace glint
