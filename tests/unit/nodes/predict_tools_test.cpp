#include "nodes/predict_tools.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "kernels/motion/predict_motion.hpp"

namespace glint {
namespace {

class PredictTools : public testing::Test {
 protected:
  PredictTools() {
    estimates_->tool_count = 1;
    EXPECT_EQ(node_.prepare(), Reason::none);
    estimates_->tips[0].arm_m = Vector3(0.1, 0, 0);
    Track& track = estimates_->tracks[0];
    track.alive = true;
    track.measured_now = true;
    track.reason = Reason::none;
    track.base = ReferenceFrame::world;
    track.newest = {Time{} + milliseconds(1000), {}};
    track.newest.pose.translation = Vector3(0, 0, 0.5);
    track.motion.time = track.newest.time;
    track.motion.pose = track.newest.pose;
  }

  PoseSample at(std::int64_t tick_ms) {
    graph::Latest<Estimates> estimates;
    estimates.set(*estimates_, 1, 0);
    graph::Latest<RobotFrame> robot;
    robot.set(robot_, 1, 0);
    graph::Latest<PenButtons> buttons;
    buttons.set(buttons_, 1, 0);
    node_(Now{Time{} + milliseconds(tick_ms), 7, 0}, estimates, robot, buttons, *samples_);
    return samples_->items[0];
  }

  std::unique_ptr<Estimates> estimates_ = std::make_unique<Estimates>();
  std::unique_ptr<PoseSamples> samples_ = std::make_unique<PoseSamples>();
  RobotFrame robot_{RegistrationState::given, {}, 0};
  PenButtons buttons_;
  glint::PredictTools node_;
};

TEST_F(PredictTools, SaysNoneBeforeTheFirstPose) {
  estimates_->tracks[0] = Track{};
  EXPECT_EQ(at(1000).state, TrackState::none);
  EXPECT_EQ(at(1000).reason, Reason::no_frame_yet);
}

TEST_F(PredictTools, IsMeasuredUpToOneAndAHalfNominalGaps) {
  node_.settings.nominal_gap = milliseconds(20);
  EXPECT_EQ(at(1030).state, TrackState::measured);
  EXPECT_EQ(at(1031).state, TrackState::predicted);
}

TEST_F(PredictTools, IsPredictedUpToLostAfterAndThenLostWithoutAPose) {
  EXPECT_EQ(at(1250).state, TrackState::predicted);
  const PoseSample lost = at(1251);
  EXPECT_EQ(lost.state, TrackState::lost);
  EXPECT_EQ(lost.reason, Reason::too_old);
  EXPECT_TRUE(lost.pose.translation.isZero());
}

TEST_F(PredictTools, IsLostWhereThePoseWasNeverToldFromAnother) {
  estimates_->tracks[0].unconfirmed = true;
  estimates_->tracks[0].reason = Reason::ambiguous;
  EXPECT_EQ(at(1010).state, TrackState::lost);
  EXPECT_EQ(at(1010).reason, Reason::ambiguous);
  EXPECT_TRUE(at(1010).pose.translation.isZero());
}

TEST_F(PredictTools, CountsItsToolsAndThoseWithAPose) {
  (void)at(1010);
  EXPECT_EQ(node_.counts(), (graph::LoopCounts{{1, 1, 1}}));
  (void)at(1251);
  EXPECT_EQ(node_.counts(), (graph::LoopCounts{{1, 1}}));
}

TEST_F(PredictTools, SaysThePensButtonsWhetherItIsSeenLostOrYetToBeSeen) {
  EXPECT_EQ(at(1010).buttons, 0);
  buttons_.held = 5;
  EXPECT_EQ(at(1010).state, TrackState::measured);
  EXPECT_EQ(at(1010).buttons, 5);
  EXPECT_EQ(at(1251).reason, Reason::too_old);
  EXPECT_EQ(at(1251).buttons, 5);
  estimates_->tracks[0] = Track{};
  EXPECT_EQ(at(1010).state, TrackState::none);
  EXPECT_EQ(at(1010).buttons, 5);
  estimates_->tracks[0].reason = Reason::too_old;
  EXPECT_EQ(at(1010).state, TrackState::lost);
  EXPECT_EQ(at(1010).buttons, 5);
}

TEST_F(PredictTools, SaysNoButtonsOfAnyToolButTheFirst) {
  estimates_->tool_count = 2;
  estimates_->tracks[1] = estimates_->tracks[0];
  buttons_.held = 7;
  EXPECT_EQ(at(1010).buttons, 7);
  EXPECT_EQ(samples_->items[1].state, TrackState::measured);
  EXPECT_EQ(samples_->items[1].buttons, 0);
}

TEST_F(PredictTools, GivesTheTipInTheRobotsFrame) {
  robot_.T_world_robot.translation = Vector3(1, 2, 3);
  const PoseSample sample = at(1010);
  EXPECT_EQ(sample.frame, ReferenceFrame::robot);
  EXPECT_TRUE(sample.pose.translation.isApprox(Vector3(0.1 - 1, -2, 0.5 - 3)));
}

// The robot's x axis is the world's y, its y axis the world's -x.
TEST_F(PredictTools, TurnsPoseSpeedsAndCovarianceIntoTheRobotsFrame) {
  Track& track = estimates_->tracks[0];
  track.motion.velocity_m_s = Vector3(0.1, 0.2, 0.3);
  track.motion.angular_velocity_rad_s = Vector3(1, 2, -3);
  track.motion.covariance.diagonal().setConstant(1e-12);
  track.head_covariance.diagonal() << 1e-6, 4e-6, 9e-6, 1e-10, 4e-10, 9e-10;
  robot_.T_world_robot.rotation = Quaternion(std::sqrt(0.5), 0, 0, std::sqrt(0.5));
  const PoseSample sample = at(1000);
  EXPECT_EQ(sample.frame, ReferenceFrame::robot);
  EXPECT_LT((sample.pose.translation - Vector3(0, -0.1, 0.5)).norm(), 1e-12);
  EXPECT_LT((sample.pose.rotation * Vector3::UnitX() + Vector3::UnitY()).norm(), 1e-12);
  EXPECT_LT((sample.angular_velocity_rad_s - Vector3(2, -1, -3)).norm(), 1e-12);
  // Velocity of the tip: the mean's plus the rotation's, (1, 2, -3) x (0.1, 0, 0) in the world.
  const Vector3 in_world = Vector3(0.1, 0.2, 0.3) + Vector3(0, -0.3, -0.2);
  const Vector3 in_robot(in_world.y(), -in_world.x(), in_world.z());
  EXPECT_LT((sample.velocity_m_s - in_robot).norm(), 1e-12);
  EXPECT_NEAR(sample.covariance(3, 3), 4e-10, 1e-11);
  EXPECT_NEAR(sample.covariance(4, 4), 1e-10, 1e-11);
  EXPECT_NEAR(sample.covariance(5, 5), 9e-10, 1e-11);
  EXPECT_NEAR(sample.covariance(0, 0), 4e-6 + 0.01 * 9e-10, 1e-9);
  EXPECT_NEAR(sample.covariance(1, 1), 1e-6, 1e-9);
}

TEST_F(PredictTools, StaysInTheWorldAndSaysSoWithoutARobotFrame) {
  robot_.state = RegistrationState::none;
  const PoseSample sample = at(1010);
  EXPECT_EQ(sample.frame, ReferenceFrame::world);
  EXPECT_EQ(sample.reason, Reason::no_reference);
  EXPECT_EQ(sample.state, TrackState::measured);
}

TEST_F(PredictTools, StaysInTheCamerasFrameWithoutAHeadPose) {
  estimates_->tracks[0].base = ReferenceFrame::camera;
  const PoseSample sample = at(1010);
  EXPECT_EQ(sample.frame, ReferenceFrame::camera);
  EXPECT_EQ(sample.reason, Reason::head_pose_missing);
}

TEST_F(PredictTools, MovesOnByTheEquationsOfMotionWithGrowingUncertainty) {
  Track& track = estimates_->tracks[0];
  track.motion.velocity_m_s = Vector3(1, 0, 0);
  track.motion.angular_velocity_rad_s = Vector3(0, 0, 2);
  track.motion.covariance.diagonal().setConstant(1e-6);
  track.motion.covariance.diagonal().segment<3>(k_velocity).setConstant(0.01);
  const PoseSample near = at(1000);
  const PoseSample far = at(1040);
  const double turn = 2 * 0.04;
  EXPECT_NEAR(far.pose.translation.x(), 0.04 + 0.1 * std::cos(turn), 1e-7);
  EXPECT_NEAR(far.pose.translation.y(), 0.1 * std::sin(turn), 1e-7);
  const Vector3 tip_velocity(1 - 0.2 * std::sin(turn), 0.2 * std::cos(turn), 0);
  EXPECT_TRUE(far.velocity_m_s.isApprox(tip_velocity, 1e-6));
  EXPECT_TRUE(far.angular_velocity_rad_s.isApprox(Vector3(0, 0, 2), 1e-9));
  // Lever arm of the tip: 0.1 m and 1e-3 rad add 1e-4 m on two axes.
  EXPECT_NEAR(near.sigma_position_m, std::sqrt(1e-6 + 2.0 / 3 * 1e-8), 1e-9);
  const UncertainPose middle =
      predict_pose(track.motion, Time{} + milliseconds(1040), {}, NoiseScale{});
  EXPECT_NEAR(far.covariance(5, 5), middle.covariance(5, 5), 1e-15);
  EXPECT_NEAR(
      far.covariance(0, 0),
      middle.covariance(0, 0) + 0.01 * std::sin(turn) * std::sin(turn) * middle.covariance(5, 5),
      1e-9);
  EXPECT_GT(far.sigma_position_m, 2 * near.sigma_position_m);
}

TEST_F(PredictTools, IsLessSureOfAHandThatHasBeenBrisk) {
  Track& track = estimates_->tracks[0];
  track.motion.covariance.diagonal().setConstant(1e-12);
  const double calm = at(1040).sigma_position_m;
  track.noise = {4, 4};
  EXPECT_GT(at(1040).sigma_position_m, 1.1 * calm);
}

TEST_F(PredictTools, IsNoSurerThanTheHeadsetItself) {
  estimates_->tracks[0].head_covariance.diagonal().setConstant(4e-6);
  EXPECT_GT(at(1000).sigma_position_m, 0.002);
}

TEST_F(PredictTools, GivesTheSystematicPartBesideTheTotal) {
  Track& track = estimates_->tracks[0];
  const double random = at(1000).covariance(2, 2);
  EXPECT_TRUE(at(1000).systematic.isZero());
  track.calibration_covariance.diagonal() << 1e-6, 0.5e-6, 1e-6, 0, 4e-6, 0;
  track.correlated_covariance(1, 1) = 0.5e-6;
  const PoseSample sample = at(1000);
  // The tip is 0.1 m along x: a rotation about y moves it along z.
  EXPECT_NEAR(sample.systematic(2, 2), 1e-6 + 0.01 * 4e-6, 1e-15);
  EXPECT_NEAR(sample.systematic(0, 0), 1e-6, 1e-15);
  EXPECT_NEAR(sample.systematic(1, 1), 1e-6, 1e-15);
  EXPECT_NEAR(sample.covariance(2, 2), random + sample.systematic(2, 2), 1e-15);
  EXPECT_NEAR(sample.sigma_position_m,
              std::sqrt(sample.covariance.topLeftCorner<3, 3>().trace() / 3), 1e-15);
}

TEST_F(PredictTools, CountsTheTipAmongSystematicErrors) {
  const PoseSample before = at(1010);
  estimates_->tips[0].sigma_m = 4e-3;
  const PoseSample after = at(1010);
  Matrix6 added = Matrix6::Zero();
  added.diagonal().head<3>().setConstant(1.6e-5);
  EXPECT_LT((after.systematic - before.systematic - added).norm(), 1e-15);
  EXPECT_LT((after.covariance - before.covariance - added).norm(), 1e-15);
}

TEST_F(PredictTools, CountsTheRobotsPlaceAmongSystematicErrors) {
  node_.settings.robot_covariance.diagonal() << 1e-6, 1e-6, 1e-6, 0, 0, 1e-6;
  robot_.T_world_robot.translation = Vector3(0, -1, 0.5);  // 1 m beside the markers' mean
  robot_.T_world_robot.rotation = Quaternion(std::sqrt(0.5), 0, 0, std::sqrt(0.5));
  const PoseSample sample = at(1000);
  ASSERT_EQ(sample.frame, ReferenceFrame::robot);
  // In the world a rotation about z moves the markers' mean along x by 1 m per radian and the tip
  // along y by 0.1 m.
  EXPECT_NEAR(sample.systematic(1, 1), 1e-6 + 1e-6, 1e-12);
  EXPECT_NEAR(sample.systematic(0, 0), 1e-6 + 0.01 * 1e-6, 1e-12);
  EXPECT_NEAR(sample.systematic(2, 2), 1e-6, 1e-12);
  robot_.state = RegistrationState::none;
  EXPECT_TRUE(at(1000).systematic.isZero()) << "in the world the robot's place does not count";
}

TEST_F(PredictTools, CountsTheStampsErrorWhereTheToolMoves) {
  node_.settings.stamp_sigma_s = 0.002;
  EXPECT_TRUE(at(1000).systematic.isZero()) << "at rest";
  estimates_->tracks[0].motion.velocity_m_s = Vector3(0, 0.5, 0);
  estimates_->tracks[0].motion.angular_velocity_rad_s = Vector3(0, 0, 2);
  const PoseSample sample = at(1000);
  const double tip_m_s = 0.5 + 0.1 * 2;
  EXPECT_NEAR(sample.systematic(1, 1), 0.002 * 0.002 * tip_m_s * tip_m_s, 1e-12);
  EXPECT_NEAR(sample.systematic(5, 5), 0.002 * 0.002 * 4, 1e-12);
  EXPECT_NEAR(sample.systematic(0, 0), 0, 1e-15);
  EXPECT_NEAR(sample.age_sigma_s, 0.002, 1e-12);
  // A frame may state the standard deviation of its own time stamp.
  estimates_->tracks[0].stamp_sigma = milliseconds(3);
  const PoseSample other = at(1000);
  EXPECT_NEAR(other.age_sigma_s, std::sqrt(13e-6), 1e-12);
  EXPECT_NEAR(other.systematic(1, 1), 13e-6 * tip_m_s * tip_m_s, 1e-12);
}

TEST_F(PredictTools, TakesTheRobotsFrameFromTheReferenceToolWhereTheCellSaysSo) {
  robot_.in_reference = true;
  robot_.T_world_robot.translation = Vector3(0, 0, 1);
  EXPECT_EQ(at(1000).frame, ReferenceFrame::world) << "the reference is yet to be seen";
  EXPECT_EQ(at(1000).reason, Reason::no_reference);
  estimates_->has_reference = true;
  estimates_->T_world_reference.translation = Vector3(0, 2, 0);
  const PoseSample sample = at(1000);
  EXPECT_EQ(sample.frame, ReferenceFrame::robot);
  EXPECT_TRUE(sample.pose.translation.isApprox(Vector3(0.1, -2, 0.5 - 1)));
}

TEST_F(PredictTools, AddsTheActuationDelayToTheLead) {
  estimates_->tracks[0].motion.velocity_m_s = Vector3(1, 0, 0);
  node_.settings.actuation_delay = milliseconds(10);
  EXPECT_NEAR(at(1000).pose.translation.x(), 0.1 + 0.01, 1e-9);
}

}  // namespace
}  // namespace glint
