// Node PredictTools: every field of a tick's sample, with and without a pose, all different.
#include <gtest/gtest.h>

#include <memory>

#include "kernels/pose/lever_arm.hpp"
#include "nodes/predict_tools.hpp"
#include "tests/unit/kernels/motion/motion_scene.hpp"

namespace glint::predict_fields_test {
namespace {

class PredictFields : public testing::Test {
 protected:
  PredictFields() {
    EXPECT_EQ(node_.prepare(), Reason::none);
    estimates_->tool_count = 3;
    estimates_->verdict.stamp.arrival = Time{} + milliseconds(1003);
    for (std::size_t t = 0; t < 3; ++t) {
      Track& track = estimates_->tracks[t];
      track.alive = track.measured_now = true;
      track.reason = Reason::none;
      track.base = ReferenceFrame::world;
      track.newest.time = track.motion.time = Time{} + milliseconds(1000);
      track.frame_sequence = 40 + t;
      track.marker_mask = static_cast<std::uint8_t>(3 + t);
    }
    robot_ = {RegistrationState::accepted, {}, 0.0042};
    buttons_.held = 6;
  }
  const PoseSample& at(std::int64_t tick_ms, std::uint64_t version = 1) {
    graph::Latest<Estimates> estimates;
    estimates.set(*estimates_, version, 0);
    graph::Latest<RobotFrame> robot;
    robot.set(robot_, 1, 0);
    graph::Latest<PenButtons> buttons;
    buttons.set(buttons_, 1, 0);
    node_(Now{Time{} + milliseconds(tick_ms), 77, 0}, estimates, robot, buttons, *samples_);
    return samples_->items[1];
  }

  std::unique_ptr<Estimates> estimates_ = std::make_unique<Estimates>();
  std::unique_ptr<PoseSamples> samples_ = std::make_unique<PoseSamples>();
  RobotFrame robot_;
  PenButtons buttons_;
  glint::PredictTools node_;
};

TEST_F(PredictFields, AreOfTheTickTheTrackAndTheRobot) {
  const PoseSample& sample = at(1010);
  EXPECT_EQ(samples_->count, 3);
  EXPECT_EQ(sample.tick, Time{} + milliseconds(1010));
  EXPECT_EQ(sample.tick_number, 77U);
  EXPECT_EQ(sample.tool, 1);
  EXPECT_EQ(samples_->items[2].tool, 2);
  EXPECT_EQ(sample.measurement, Time{} + milliseconds(1000));
  EXPECT_EQ(sample.frame_sequence, 41U);
  EXPECT_EQ(sample.marker_mask, 4);
  EXPECT_EQ(sample.registration, RegistrationState::accepted);
  EXPECT_EQ(sample.registration_rms_m, 0.0042);
  EXPECT_EQ(sample.frame, ReferenceFrame::robot) << "accepted is as good as given";
  EXPECT_EQ(sample.reason, Reason::none);
  EXPECT_EQ(samples_->items[0].buttons, 6);
  EXPECT_EQ(node_.counts(), (graph::LoopCounts{{1, 3, 3}}));
}

TEST_F(PredictFields, WithoutAPoseSayWhoseAndWhyAndNothingElse) {
  estimates_->tracks[1].reason = Reason::no_labeling;
  const PoseSample lost = at(1300);
  EXPECT_EQ(lost.state, TrackState::lost);
  EXPECT_EQ(lost.reason, Reason::no_labeling) << "why it was not found stands before its age";
  EXPECT_EQ(samples_->items[0].reason, Reason::too_old);
  EXPECT_EQ(lost.measurement, Time{} + milliseconds(1000));
  EXPECT_EQ(lost.frame_sequence, 41U);
  EXPECT_EQ(lost.marker_mask, 0);
  EXPECT_EQ(lost.registration, RegistrationState::accepted);
  EXPECT_EQ(lost.registration_rms_m, 0.0042);
  estimates_->tracks[1].alive = false;
  const PoseSample none = at(1010);
  EXPECT_EQ(none.state, TrackState::lost);
  EXPECT_EQ(none.measurement, Time{});
  EXPECT_EQ(none.frame_sequence, 0U);
  EXPECT_EQ(none.tool, 1);
  EXPECT_EQ(node_.counts(), (graph::LoopCounts{{1, 3, 2}}));
}

TEST_F(PredictFields, OfATickAreWhatItRestsOn) {
  (void)at(1010, 1);
  EXPECT_TRUE(samples_->any_frame);
  EXPECT_EQ(samples_->newest_frame, Time{} + milliseconds(1003));
  (void)at(1010, 0);
  EXPECT_FALSE(samples_->any_frame);
}

TEST_F(PredictFields, AreOfNoMoreToolsThanTheCellHas) {
  node_.limits.tools = 2;
  (void)at(1010);
  EXPECT_EQ(samples_->count, 2);
  EXPECT_EQ(node_.counts(), (graph::LoopCounts{{1, 2, 2}}));
}

// The substitute for a late frame never has state `measured`.
TEST_F(PredictFields, OfASubstituteArePredicted) {
  EXPECT_EQ(at(1001).state, TrackState::measured);
  for (const Reason reason : {Reason::overrun_held, Reason::overrun_predicted}) {
    estimates_->tracks[1].reason = reason;
    EXPECT_EQ(at(1001).state, TrackState::predicted);
    EXPECT_EQ(at(1001).reason, reason);
  }
  estimates_->tracks[1].reason = Reason::no_labeling;
  EXPECT_EQ(at(1001).state, TrackState::measured) << "missed in a frame as young as this";
}

TEST_F(PredictFields, KeepWhyATrackIsMissedInAnyFrame) {
  estimates_->tracks[1].reason = Reason::bad_fit;
  estimates_->tracks[1].base = ReferenceFrame::camera;
  EXPECT_EQ(at(1010).reason, Reason::bad_fit);
  estimates_->tracks[1].base = ReferenceFrame::world;
  EXPECT_EQ(at(1010).reason, Reason::bad_fit);
  for (const RegistrationState state : {RegistrationState::none, RegistrationState::refused}) {
    robot_.state = state;
    EXPECT_EQ(at(1010).reason, Reason::bad_fit);
    EXPECT_EQ(at(1010).frame, ReferenceFrame::world);
    EXPECT_EQ(samples_->items[0].reason, Reason::no_reference);
  }
}

// A third of the trace of position and of rotation; each variance differs.
TEST_F(PredictFields, OfSigmaAreRootsOfTheMeanVariance) {
  estimates_->tracks[1].head_covariance.diagonal() << 1e-6, 4e-6, 9e-6, 16e-6, 25e-6, 36e-6;
  const PoseSample& sample = at(1000);
  EXPECT_NEAR(sample.sigma_position_m, std::sqrt(14e-6 / 3), 1e-12);
  EXPECT_NEAR(sample.sigma_orientation_rad, std::sqrt(77e-6 / 3), 1e-12);
}

// Systematic covariances of the camera, of successive poses and of the robot's registration add up;
// none cancels another.
TEST_F(PredictFields, OfSystematicErrorsAddUp) {
  test::Random random(4);
  Track& track = estimates_->tracks[1];
  track.calibration_covariance = test::random_covariance<6>(random, 0.002);
  track.correlated_covariance = test::random_covariance<6>(random, 0.003);
  robot_.state = RegistrationState::none;
  const PoseSample in_world = at(1000);
  EXPECT_LT(
      (in_world.systematic - track.calibration_covariance - track.correlated_covariance).norm(),
      1e-15);
  robot_.state = RegistrationState::given;
  node_.settings.robot_covariance = test::random_covariance<6>(random, 0.004);
  const PoseSample in_robot = at(1000);
  const Matrix6 sum = in_world.systematic + node_.settings.robot_covariance;
  EXPECT_LT((in_robot.systematic - sum).norm(), 1e-15) << "robot, tool and world lie at one place";
  EXPECT_LT((in_robot.covariance - in_robot.systematic - in_world.covariance + in_world.systematic)
                .norm(),
            1e-15);
}

TEST_F(PredictFields, TurnTheCovariancesIntoTheRobotsFrame) {
  test::Random random(5);
  Track& track = estimates_->tracks[1];
  track.calibration_covariance = test::random_covariance<6>(random, 0.002);
  track.head_covariance = test::random_covariance<6>(random, 0.003);
  track.motion.pose = {random.rotation(), Vector3(1, 2, 3)};
  track.motion.velocity_m_s = Vector3(0.1, 0.2, 0.3);
  track.motion.angular_velocity_rad_s = Vector3(1, 2, 3);
  estimates_->tips[1].arm_m = Vector3(0.1, 0.2, -0.1);
  robot_.state = RegistrationState::none;
  const PoseSample world = at(1000);
  robot_.state = RegistrationState::given;
  robot_.T_world_robot = {random.rotation(), Vector3(0.5, -1, 2)};
  const PoseSample robot = at(1000);
  const Quaternion turn = robot_.T_world_robot.rotation.conjugate();
  const Pose expected = robot_.T_world_robot.inverse() * world.pose;
  EXPECT_LT((robot.pose.translation - expected.translation).norm(), 1e-12);
  EXPECT_LT((robot.velocity_m_s - turn * world.velocity_m_s).norm(), 1e-12);
  EXPECT_LT((robot.angular_velocity_rad_s - turn * world.angular_velocity_rad_s).norm(), 1e-12);
  EXPECT_LT((robot.covariance - rotated_covariance(world.covariance, turn)).norm(), 1e-15);
  EXPECT_LT((robot.systematic - rotated_covariance(world.systematic, turn)).norm(), 1e-15);
  EXPECT_NEAR(robot.sigma_position_m, world.sigma_position_m, 1e-12);
}

}  // namespace
}  // namespace glint::predict_fields_test
