// The controller's C decoder, judged by the encoder of kernels/wire.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "kernels/wire/node_frames.hpp"
#include "tests/unit/kernels/wire/samples.hpp"
#include "tests/unit/platform/sinks/can/controller_receiver.hpp"

namespace glint::controller_test {
namespace {

constexpr double k_half = 0.5 + 1e-6;

INSTANTIATE_TEST_SUITE_P(Formats, ControllerOf, testing::Values(CanFormat::classic, CanFormat::fd),
                         [](const auto& format) {
                           return format.param == CanFormat::fd ? "Fd" : "Classic";
                         });

TEST_P(ControllerOf, DecodesWhatWasEncoded) {
  const bool fd = GetParam() == CanFormat::fd;
  std::mt19937 random(311);
  for (int i = 0; i < 2000; ++i) {
    const PoseSample sample = random_sample(random);
    glint_set set{};
    for (const CanFrame& frame : frames_of(sample, GetParam())) {
      const glint_frame received = c_frame(frame);
      const std::uint32_t base = k_can_base_default + k_can_tool_stride * sample.tool;
      ASSERT_EQ(glint_decode(&received, frame.identifier - base, &set), GLINT_PARTIAL);
    }
    ASSERT_TRUE(set.has_position && set.has_rotation);
    const double position_step = fd ? 1e-6 : 50e-6;
    const double age_step = fd ? 1e-4 : 2e-4;
    const double largest_sigma = fd ? 0xFFFF : 0x3FF;
    Quaternion turn(set.rotation[3], set.rotation[0], set.rotation[1], set.rotation[2]);
    EXPECT_NEAR(turn.norm(), 0x1p30, fd ? 2 : 0x1p30 * 4e-5);
    turn.normalize();
    EXPECT_LE(turn.angularDistance(sample.pose.rotation), fd ? 1e-8 : 6.5e-5);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_LE(std::abs(set.position_um[axis] * 1e-6 - sample.pose.translation[axis]),
                k_half * position_step);
      EXPECT_LE(std::abs(set.velocity[axis] * 1e-4 - sample.velocity_m_s[axis]), k_half * 1e-4);
      EXPECT_LE(std::abs(set.angular_velocity[axis] * 1e-3 - sample.angular_velocity_rad_s[axis]),
                k_half * 1e-3);
    }
    const double sigma = sample.sigma_position_m / 1e-5;
    EXPECT_NEAR(set.sigma_position, std::min(sigma, largest_sigma), k_half);
    EXPECT_NEAR(set.age * 1e-4, sample.age().seconds(), k_half * age_step);
    EXPECT_EQ(set.state, static_cast<int>(sample.state));
    EXPECT_EQ(set.registration, static_cast<int>(sample.registration));
    EXPECT_EQ(set.markers, std::popcount(sample.marker_mask));
    EXPECT_EQ(set.buttons, sample.buttons);
    EXPECT_EQ(set.counter, sample.tick_number % (fd ? 256 : 15));
  }
}

TEST_P(ControllerOf, RefusesOtherLengthsAndFormats) {
  for (const CanFrame& frame : frames_of(circle(3), GetParam())) {
    const std::uint32_t message = frame.identifier - k_can_base_default;
    glint_set set{};
    glint_frame shorter = c_frame(frame);
    --shorter.length;
    EXPECT_EQ(glint_decode(&shorter, message, &set), GLINT_WRONG_FORMAT);
    glint_frame other = c_frame(frame);
    other.fd = !other.fd;
    EXPECT_EQ(glint_decode(&other, message, &set), GLINT_WRONG_FORMAT);
    const glint_frame of_another_tool{frame.identifier + 16, frame.fd, frame.length,
                                      frame.data.data()};
    EXPECT_EQ(glint_decode(&of_another_tool, message, &set), GLINT_WRONG_CHECK);
  }
}

// Of the heartbeats, only "stopped" matters, and only one with the right length.
TEST_P(ControllerOf, StopsByTheHeartbeatOfAStoppedNodeUntilItIsEnabled) {
  Receiver r(GetParam());
  r.start(50);
  const std::uint64_t now = 49 * k_cycle_us;
  for (const CanNodeState state :
       {CanNodeState::boot_up, CanNodeState::operational, CanNodeState::pre_operational}) {
    EXPECT_EQ(r.send(heartbeat_frame(32, state), now), GLINT_IGNORED);
  }
  EXPECT_EQ(r.send(heartbeat_frame(33, CanNodeState::stopped), now), GLINT_IGNORED);
  CanFrame longer = heartbeat_frame(32, CanNodeState::stopped);
  longer.length = 2;
  EXPECT_EQ(r.send(longer, now), GLINT_WRONG_FORMAT);
  EXPECT_EQ(glint_cycle(&r.controller, now), GLINT_FOLLOW);
  EXPECT_EQ(r.send(heartbeat_frame(32, CanNodeState::stopped), now), GLINT_NODE_STOPPED);
  EXPECT_EQ(glint_cycle(&r.controller, now), GLINT_STOP);
  EXPECT_EQ(r.send(circle(50), now + k_cycle_us), GLINT_ACCEPTED);
  EXPECT_EQ(glint_cycle(&r.controller, now + k_cycle_us), GLINT_STOP) << "a set enables nothing";
  EXPECT_TRUE(glint_enable(&r.controller, now + k_cycle_us));
  EXPECT_EQ(glint_cycle(&r.controller, now + k_cycle_us), GLINT_FOLLOW);
}

TEST_P(ControllerOf, FollowsUntilThreeCyclesAreMissedAndStopsAfterFive) {
  Receiver r(GetParam());
  EXPECT_FALSE(glint_enable(&r.controller, 0)) << "nothing was received";
  r.start(50);
  const std::uint64_t last = 49 * k_cycle_us;
  EXPECT_EQ(glint_cycle(&r.controller, last + 3 * k_cycle_us), GLINT_FOLLOW);
  EXPECT_EQ(glint_cycle(&r.controller, last + 3 * k_cycle_us + 1), GLINT_RAMP);
  EXPECT_EQ(glint_cycle(&r.controller, last + 5 * k_cycle_us - 1), GLINT_RAMP);
  EXPECT_EQ(glint_cycle(&r.controller, last + 5 * k_cycle_us), GLINT_STOP);
  EXPECT_EQ(r.send(circle(54), last + 5 * k_cycle_us), GLINT_JUMPED) << "4 sets are missing";
  EXPECT_EQ(r.send(circle(55), last + 6 * k_cycle_us), GLINT_JUMPED);
  EXPECT_EQ(r.send(circle(56), last + 7 * k_cycle_us), GLINT_ACCEPTED) << "the third in order";
  EXPECT_EQ(glint_cycle(&r.controller, last + 7 * k_cycle_us), GLINT_STOP) << "until enabled";
  EXPECT_TRUE(glint_enable(&r.controller, last + 7 * k_cycle_us));
  EXPECT_EQ(glint_cycle(&r.controller, last + 7 * k_cycle_us), GLINT_FOLLOW);
}

TEST_P(ControllerOf, FollowsAgainAfterARamp) {
  Receiver r(GetParam());
  r.start(50);
  const std::uint64_t now = 53 * k_cycle_us;
  EXPECT_EQ(glint_cycle(&r.controller, now), GLINT_RAMP) << "ticks 50 to 53 are missing";
  EXPECT_EQ(r.send(circle(52), now), GLINT_ACCEPTED) << "the counter advanced by 3";
  EXPECT_EQ(glint_cycle(&r.controller, now), GLINT_FOLLOW);
}

TEST_P(ControllerOf, StopsAfterATenthOfASecondOfPredictions) {
  Receiver r(GetParam());
  r.start(50);
  const std::uint64_t last = 49 * k_cycle_us;
  for (std::uint64_t tick = 50; tick < 80; ++tick) {
    PoseSample sample = circle(tick);
    sample.state = TrackState::predicted;
    const std::uint64_t now = tick * k_cycle_us;
    EXPECT_EQ(r.send(sample, now), GLINT_ACCEPTED);
    EXPECT_EQ(glint_cycle(&r.controller, now), now - last < 100'000 ? GLINT_FOLLOW : GLINT_STOP);
  }
  EXPECT_FALSE(glint_enable(&r.controller, 80 * k_cycle_us));
}

TEST_P(ControllerOf, RejectsOldLostAndImplausiblePoses) {
  Receiver r(GetParam());
  r.start(50);
  PoseSample old = circle(50);
  old.measurement = old.measurement - microseconds(100'000);
  EXPECT_EQ(r.send(old, 50 * k_cycle_us), GLINT_TOO_OLD);
  PoseSample lost = circle(51);
  lost.state = TrackState::lost;
  EXPECT_EQ(r.send(lost, 51 * k_cycle_us), GLINT_NO_POSE);
  // Three cycles of 2 m/s and 3 x 1 mm allow 27 mm along each axis.
  PoseSample far = circle(52);
  far.pose.translation.y() = r.controller.accepted.position_um[1] * 1e-6 + 0.02705;
  EXPECT_EQ(r.send(far, 52 * k_cycle_us), GLINT_IMPLAUSIBLE);
  EXPECT_EQ(glint_cycle(&r.controller, 52 * k_cycle_us), GLINT_FOLLOW) << "of tick 49";
  PoseSample near = far;
  near.tick_number = 53;
  near.tick = near.tick + microseconds(4000);
  near.measurement = near.measurement + microseconds(4000);
  EXPECT_EQ(r.send(near, 53 * k_cycle_us), GLINT_ACCEPTED) << "four cycles allow 35 mm";
}

TEST_P(ControllerOf, RejectsAPoseThatDoesNotFitItsFields) {
  Receiver r(GetParam());
  r.start(50);
  PoseSample outside = circle(50);
  outside.pose.translation.x() = 3000;
  EXPECT_EQ(r.send(outside, 50 * k_cycle_us), GLINT_NO_POSE);
  PoseSample unturned = circle(51);
  unturned.pose.rotation = Quaternion(0, 0, 0, 0);
  EXPECT_EQ(r.send(unturned, 51 * k_cycle_us), GLINT_NO_POSE);
}

TEST(Controller, AcceptsTheFiveMessagesOfASetInAnyOrder) {
  Receiver r(CanFormat::classic);
  r.start(50);
  std::vector<CanFrame> frames = frames_of(circle(50), CanFormat::classic);
  std::ranges::reverse(frames);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(r.send(frames[i], 50 * k_cycle_us), GLINT_PARTIAL);
  EXPECT_EQ(r.send(frames[4], 50 * k_cycle_us), GLINT_ACCEPTED);
  EXPECT_EQ(r.send(frames[4], 50 * k_cycle_us), GLINT_PARTIAL) << "one message again";
  EXPECT_EQ(r.send(circle(51), 51 * k_cycle_us), GLINT_ACCEPTED);
  EXPECT_EQ(r.controller.count[GLINT_INCOMPLETE], 1U);
}

TEST_P(ControllerOf, AcceptsNoSetThatAGatewayDeliversLate) {
  Receiver r(GetParam());
  r.start(50);
  const std::uint64_t now = 50 * k_cycle_us;
  for (std::uint64_t tick = 40; tick < 50; ++tick)
    EXPECT_NE(r.send(circle(tick), now), GLINT_ACCEPTED);
  EXPECT_EQ(r.send(circle(50), now), GLINT_ACCEPTED);
  EXPECT_EQ(r.send(circle(53), now), GLINT_JUMPED) << "three sets in no time";
}

}  // namespace
}  // namespace glint::controller_test
