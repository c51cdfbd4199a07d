#include "nodes/overrun_effects.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "nodes/predict_tools.hpp"

namespace glint {
namespace {

using graph::OverrunPolicy;

constexpr Duration k_lost_after = milliseconds(250);

// One tool that moves at 1 m/s along x, seen at 980 and 1000 ms; x = 0 then.
std::unique_ptr<Estimates> moving() {
  auto estimates = std::make_unique<Estimates>();
  estimates->tool_count = 2;
  Track& track = estimates->tracks[0];
  track.alive = true;
  track.measured_now = true;
  track.has_previous = true;
  track.reason = Reason::none;
  track.base = ReferenceFrame::world;
  track.newest = {Time{} + milliseconds(1000), {}};
  track.previous = {Time{} + milliseconds(980), {}};
  track.previous.pose.translation.x() = -0.020;
  track.motion.time = track.newest.time;
  track.motion.velocity_m_s.x() = 1;
  return estimates;
}

OverrunFrame frame_at(std::int64_t ms) {
  OverrunFrame frame;
  frame.stamp.mid_exposure = Time{} + milliseconds(ms);
  frame.stamp.sequence = 77;
  frame.head.valid = true;
  frame.lost_after = k_lost_after;
  return frame;
}

PoseSample sample_of(const Estimates& estimates, std::int64_t tick_ms) {
  graph::Latest<Estimates> latest;
  latest.set(estimates, 1, 0);
  graph::Latest<RobotFrame> robot;
  robot.set({RegistrationState::given, {}, 0}, 1, 0);
  auto samples = std::make_unique<PoseSamples>();
  PredictTools predict;
  EXPECT_EQ(predict.prepare(), Reason::none);
  predict(Now{Time{} + milliseconds(tick_ms), 5, 0}, latest, robot, {}, *samples);
  return samples->items[0];
}

TEST(FrameOverrun, PublishesNothingWhenItSkips) {
  Estimates out;
  EXPECT_FALSE(substitute(OverrunPolicy::skip_output, frame_at(1020), *moving(), out));
}

TEST(FrameOverrun, LetsAHeldToolStandStillAndNoLongerCallsItMeasured) {
  auto out = std::make_unique<Estimates>();
  ASSERT_TRUE(substitute(OverrunPolicy::hold_last, frame_at(1020), *moving(), *out));
  EXPECT_EQ(out->verdict.reason, Reason::overrun_held);
  EXPECT_EQ(out->verdict.stamp.sequence, 77u);
  const PoseSample sample = sample_of(*out, 1024);
  EXPECT_EQ(sample.state, TrackState::predicted);
  EXPECT_EQ(sample.reason, Reason::overrun_held);
  EXPECT_EQ(sample.pose.translation.x(), 0);
  EXPECT_EQ(sample.measurement, Time{} + milliseconds(1000)) << "its age goes on growing";
  EXPECT_EQ(sample_of(*moving(), 1024).state, TrackState::measured);
}

TEST(FrameOverrun, MovesAPredictedToolOnAtItsLastVelocity) {
  auto out = std::make_unique<Estimates>();
  ASSERT_TRUE(substitute(OverrunPolicy::predict, frame_at(1020), *moving(), *out));
  EXPECT_NEAR(out->tracks[0].T_camera_tool.translation.x(), 0.020, 1e-12);
  EXPECT_FALSE(out->tracks[0].measured_now);
  const PoseSample sample = sample_of(*out, 1024);
  EXPECT_EQ(sample.state, TrackState::predicted);
  EXPECT_EQ(sample.reason, Reason::overrun_predicted);
  EXPECT_NEAR(sample.pose.translation.x(), 0.024, 1e-12);
  EXPECT_EQ(sample.measurement, Time{} + milliseconds(1000));
}

// Without a head pose a tool's base is the camera, whatever the frame's head pose is.
TEST(FrameOverrun, MovesAPredictedToolOnInTheCamerasFrame) {
  auto in_time = moving();
  in_time->tracks[0].base = ReferenceFrame::camera;
  for (const bool valid : {false, true}) {
    OverrunFrame frame = frame_at(1020);
    frame.head.valid = valid;
    frame.head.T_world_camera.translation.y() = 3;
    auto out = std::make_unique<Estimates>();
    ASSERT_TRUE(substitute(OverrunPolicy::predict, frame, *in_time, *out));
    EXPECT_NEAR(out->tracks[0].T_camera_tool.translation.x(), 0.020, 1e-12);
    EXPECT_EQ(out->tracks[0].T_camera_tool.translation.y(), 0);
  }
}

TEST(FrameOverrun, DeclaresEveryToolLostWhenItStops) {
  auto out = std::make_unique<Estimates>();
  ASSERT_TRUE(substitute(OverrunPolicy::stop_safe, frame_at(1020), *moving(), *out));
  EXPECT_EQ(sample_of(*out, 1024).state, TrackState::lost);
  EXPECT_EQ(sample_of(*out, 1024).reason, Reason::overrun_stopped);
  EXPECT_EQ(out->tracks[1].reason, Reason::overrun_stopped);
}

// The tool continues in the world frame while the head moves.
TEST(FrameOverrun, MovesAPredictedToolOnBeforeAHeadThatMoved) {
  OverrunFrame frame = frame_at(1020);
  frame.head.T_world_camera.translation = {0.5, 0, -1};
  frame.head.T_world_camera.rotation = Quaternion(std::sqrt(0.5), 0, 0, std::sqrt(0.5));
  auto out = std::make_unique<Estimates>();
  ASSERT_TRUE(substitute(OverrunPolicy::predict, frame, *moving(), *out));
  // (0.02, 0, 0) minus (0.5, 0, -1), rotated back by 90 degrees about z.
  const Vector3 seen = out->tracks[0].T_camera_tool.translation;
  EXPECT_LT((seen - Vector3(0, 0.48, 1)).norm(), 1e-12);
  frame.head.valid = false;
  auto held = moving();
  held->tracks[0].T_camera_tool.translation = {7, 8, 9};
  ASSERT_TRUE(substitute(OverrunPolicy::predict, frame, *held, *out));
  EXPECT_EQ(out->tracks[0].T_camera_tool.translation, Vector3(7, 8, 9)) << "no head, no camera";
}

TEST(FrameOverrun, GoesOnNoLongerThanAToolIsKept) {
  auto out = std::make_unique<Estimates>();
  ASSERT_TRUE(substitute(OverrunPolicy::predict, frame_at(2000), *moving(), *out));
  EXPECT_NEAR(out->tracks[0].T_camera_tool.translation.x(), 0.250, 1e-12);
  auto once = moving();
  once->tracks[0].has_previous = false;
  once->tracks[0].T_camera_tool.translation = {7, 8, 9};
  ASSERT_TRUE(substitute(OverrunPolicy::predict, frame_at(1020), *once, *out));
  EXPECT_EQ(out->tracks[0].T_camera_tool.translation, Vector3(7, 8, 9)) << "seen once";
  EXPECT_EQ(out->tracks[0].reason, Reason::overrun_predicted);
}

// Velocity and acceleration are zero; the last pose stays.
TEST(FrameOverrun, StopsEveryMotionOfAHeldTool) {
  auto in_time = moving();
  MotionState& motion = in_time->tracks[0].motion;
  motion.pose.translation = {1, 2, 3};
  motion.velocity_m_s = motion.acceleration_m_s2 = {1, 2, 3};
  motion.angular_velocity_rad_s = motion.angular_acceleration_rad_s2 = {4, 5, 6};
  auto out = std::make_unique<Estimates>();
  ASSERT_TRUE(substitute(OverrunPolicy::hold_last, frame_at(1020), *in_time, *out));
  const Track& track = out->tracks[0];
  EXPECT_TRUE(track.motion.velocity_m_s.isZero() && track.motion.acceleration_m_s2.isZero());
  EXPECT_TRUE(track.motion.angular_velocity_rad_s.isZero());
  EXPECT_TRUE(track.motion.angular_acceleration_rad_s2.isZero());
  EXPECT_EQ(track.motion.pose.translation, Vector3(1, 2, 3));
  EXPECT_FALSE(track.has_previous || track.measured_now);
  EXPECT_TRUE(track.alive);
}

TEST(FrameOverrun, LeavesAToolThatWasNotFoundAsItWas) {
  for (const OverrunPolicy policy : {OverrunPolicy::hold_last, OverrunPolicy::predict}) {
    auto in_time = moving();
    in_time->tracks[1].reason = Reason::no_labeling;
    in_time->tracks[2].reason = Reason::bad_fit;  // beyond the tools
    in_time->tracks[2].alive = true;
    auto out = std::make_unique<Estimates>();
    ASSERT_TRUE(substitute(policy, frame_at(1020), *in_time, *out));
    EXPECT_EQ(out->tracks[0].reason, reason_of(policy));
    EXPECT_EQ(out->tracks[1].reason, Reason::no_labeling);
    EXPECT_EQ(out->tracks[2].reason, Reason::bad_fit);
    EXPECT_EQ(out->tool_count, 2);
    EXPECT_FALSE(out->verdict.usable());
  }
}

TEST(ReasonOfPolicy, IsItsOwn) {
  EXPECT_EQ(reason_of(OverrunPolicy::skip_output), Reason::overrun_skipped);
  EXPECT_EQ(reason_of(OverrunPolicy::hold_last), Reason::overrun_held);
  EXPECT_EQ(reason_of(OverrunPolicy::predict), Reason::overrun_predicted);
  EXPECT_EQ(reason_of(OverrunPolicy::stop_safe), Reason::overrun_stopped);
}

// Output of the tick at 1000 ms: a measurement 10 ms old, moving at 2 m/s along y, draw held.
std::unique_ptr<PoseSamples> previous_output(int tool = 0) {
  auto samples = std::make_unique<PoseSamples>();
  samples->count = 1;
  PoseSample& sample = samples->items[0];
  sample.tick = Time{} + milliseconds(1000);
  sample.tick_number = 250;
  sample.tool = tool;
  sample.frame_sequence = 77;
  sample.registration = RegistrationState::given;
  sample.registration_rms_m = 0.002;
  sample.measurement = Time{} + milliseconds(990);
  sample.state = TrackState::measured;
  sample.reason = Reason::none;
  sample.buttons = 1;
  sample.velocity_m_s.y() = 2;
  sample.angular_velocity_rad_s.z() = 1;
  return samples;
}

PoseSample after(OverrunPolicy policy, std::int64_t tick_ms, PenButtons buttons = {},
                 int tool = 0) {
  auto out = std::make_unique<PoseSamples>();
  const Now now{Time{} + milliseconds(tick_ms), static_cast<std::uint32_t>(tick_ms / 4), 0};
  EXPECT_TRUE(substitute(policy, {now, k_lost_after, buttons}, *previous_output(tool), *out));
  EXPECT_EQ(out->count, 1);
  return out->items[0];
}

TEST(TickOverrun, LetsNothingLeaveWhenItSkips) {
  PoseSamples out;
  EXPECT_FALSE(
      substitute(OverrunPolicy::skip_output, {Now{}, k_lost_after, {}}, *previous_output(), out));
}

TEST(TickOverrun, SendsTheLastSamplesAgainOlder) {
  const PoseSample sample = after(OverrunPolicy::hold_last, 1008);
  EXPECT_EQ(sample.state, TrackState::predicted);
  EXPECT_EQ(sample.reason, Reason::overrun_held);
  EXPECT_EQ(sample.tick_number, 252u);
  EXPECT_EQ(sample.age(), milliseconds(18));
  EXPECT_TRUE(sample.pose.translation.isZero());
}

TEST(TickOverrun, MovesTheLastSamplesOnByTheirVelocities) {
  const PoseSample sample = after(OverrunPolicy::predict, 1008);
  EXPECT_EQ(sample.reason, Reason::overrun_predicted);
  EXPECT_NEAR(sample.pose.translation.y(), 0.016, 1e-12);
  EXPECT_NEAR(rotation_vector(sample.pose.rotation).z(), 0.008, 1e-12);
}

TEST(TickOverrun, DeclaresTheToolLostWhenItStops) {
  const PoseSample sample = after(OverrunPolicy::stop_safe, 1008);
  EXPECT_EQ(sample.state, TrackState::lost);
  EXPECT_EQ(sample.reason, Reason::overrun_stopped);
  EXPECT_TRUE(sample.velocity_m_s.isZero());
}

TEST(TickOverrun, LeavesALostSampleWhoseItIsAndNoPose) {
  const PoseSample lost = after(OverrunPolicy::stop_safe, 1008, {}, 2);
  const PoseSample was = previous_output(2)->items[0];
  EXPECT_EQ(lost.tick, Time{} + milliseconds(1008));
  EXPECT_EQ(lost.tick_number, 252u);
  EXPECT_EQ(lost.tool, 2);
  EXPECT_EQ(lost.measurement, was.measurement);
  EXPECT_EQ(lost.frame_sequence, was.frame_sequence);
  EXPECT_EQ(lost.registration, was.registration);
  EXPECT_EQ(lost.registration_rms_m, was.registration_rms_m);
  EXPECT_FALSE(lost.has_pose());
  EXPECT_TRUE(lost.angular_velocity_rad_s.isZero());
}

// Position first, then the rotation about the tip, over the time since the last tick.
TEST(TickOverrun, MovesEachSampleOnAndSaysOfWhichFrameTheyAre) {
  auto in_time = previous_output();
  in_time->any_frame = true;
  in_time->newest_frame = Time{} + milliseconds(995);
  in_time->count = 2;
  in_time->items[1] = in_time->items[0];
  in_time->items[1].tool = 1;
  in_time->items[1].pose = {from_rotation_vector(Vector3(0.3, 0, 0)), Vector3(1, 2, 3)};
  in_time->items[1].velocity_m_s = {-1, 0, 0.5};
  in_time->items[1].angular_velocity_rad_s = {0, 10, 0};
  auto out = std::make_unique<PoseSamples>();
  const OverrunTick tick{{Time{} + milliseconds(1020), 255, 0}, k_lost_after, {}};
  ASSERT_TRUE(substitute(OverrunPolicy::predict, tick, *in_time, *out));
  EXPECT_EQ(out->count, 2);
  EXPECT_TRUE(out->any_frame);
  EXPECT_EQ(out->newest_frame, in_time->newest_frame);
  EXPECT_NEAR(out->items[0].pose.translation.y(), 0.04, 1e-12);
  const PoseSample& second = out->items[1];
  EXPECT_LT((second.pose.translation - Vector3(0.98, 2, 3.01)).norm(), 1e-12);
  const Quaternion turned =
      from_rotation_vector(Vector3(0, 0.2, 0)) * from_rotation_vector(Vector3(0.3, 0, 0));
  EXPECT_LT(rotation_vector(second.pose.rotation * turned.conjugate()).norm(), 1e-12);
  EXPECT_NEAR(second.pose.rotation.norm(), 1, 1e-15);
  EXPECT_EQ(second.velocity_m_s, in_time->items[1].velocity_m_s);
  EXPECT_EQ(second.state, TrackState::predicted);
  EXPECT_EQ(second.tick_number, 255U);
}

TEST(TickOverrun, LeavesWhyASampleHadNoPose) {
  auto in_time = previous_output();
  in_time->items[0].state = TrackState::none;
  in_time->items[0].reason = Reason::no_frame_yet;
  auto out = std::make_unique<PoseSamples>();
  const OverrunTick tick{{Time{} + milliseconds(1004), 251, 0}, k_lost_after, {3}};
  ASSERT_TRUE(substitute(OverrunPolicy::predict, tick, *in_time, *out));
  EXPECT_EQ(out->items[0].state, TrackState::none);
  EXPECT_EQ(out->items[0].reason, Reason::no_frame_yet);
  EXPECT_EQ(out->items[0].tick, tick.now.tick);
  EXPECT_EQ(out->items[0].buttons, 3);
  EXPECT_TRUE(out->items[0].pose.translation.isZero());
}

TEST(TickOverrun, LosesAToolThatIsHeldForTooLong) {
  EXPECT_EQ(after(OverrunPolicy::hold_last, 1240).state, TrackState::predicted);
  const PoseSample sample = after(OverrunPolicy::hold_last, 1244);
  EXPECT_EQ(sample.state, TrackState::lost);
  EXPECT_EQ(sample.reason, Reason::too_old);
}

TEST(TickOverrun, SaysTheButtonsThatAreHeldByThen) {
  for (const OverrunPolicy policy :
       {OverrunPolicy::hold_last, OverrunPolicy::predict, OverrunPolicy::stop_safe}) {
    EXPECT_EQ(after(policy, 1008, {6}).buttons, 6);
    EXPECT_EQ(after(policy, 1008, {0}).buttons, 0) << "draw was let go";
    EXPECT_EQ(after(policy, 1244, {6}).state, TrackState::lost);
    EXPECT_EQ(after(policy, 1244, {6}).buttons, 6);
  }
}

TEST(TickOverrun, SaysNoButtonsOfAnyToolButTheFirst) {
  const auto in_time = previous_output();
  in_time->items[0].tool = 1;
  auto out = std::make_unique<PoseSamples>();
  const OverrunTick tick{{in_time->items[0].tick, 250, 0}, k_lost_after, {7}};
  EXPECT_TRUE(substitute(OverrunPolicy::hold_last, tick, *in_time, *out));
  EXPECT_EQ(out->items[0].buttons, 0);
}

}  // namespace
}  // namespace glint
