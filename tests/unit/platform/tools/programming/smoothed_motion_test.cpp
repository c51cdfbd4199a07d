#include "platform/tools/programming/smoothed_motion.hpp"

#include <gtest/gtest.h>

#include "kernels/motion/interpolate.hpp"
#include "platform/input_error.hpp"
#include "tests/unit/platform/tools/programming/strokes.hpp"

namespace glint {
namespace {

constexpr double k_white_m = 0.0005, k_common_m = 0.002;

Vector3 true_place(Time time) {
  const double t = Duration{time.nanoseconds}.seconds();
  return {0.05 * std::sin(3 * t), 0.03 * std::cos(2 * t), 0.4};
}

// Frames of a tool that translates, each with white noise and all with one common error.
std::vector<MeasuredFrame> drawn(int count, Duration period,
                                 const Vector3& common = Vector3::Zero()) {
  test::Random random(17);
  std::vector<MeasuredFrame> frames(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    MeasuredFrame& drawn = frames[static_cast<std::size_t>(i)];
    UncertainPose& measured = drawn.frame.measured;
    measured.time = at_ms(1000) + period * i;
    measured.pose.translation = true_place(measured.time) + random.vector(k_white_m) + common;
    measured.covariance.diagonal() << Vector3::Constant(k_white_m * k_white_m),
        Vector3::Constant(1e-4);
    drawn.base = ReferenceFrame::world;
    drawn.has_robot = true;
    drawn.restarts = i == 0;
    drawn.systematic.topLeftCorner<3, 3>() = Matrix3::Identity() * k_common_m * k_common_m;
  }
  return frames;
}

PoseSample tick_at(Time time) {
  PoseSample sample;
  sample.tick = time;
  sample.state = TrackState::predicted;
  return sample;
}

bool covers(const SmoothedMotion& motion, Time time) {
  PoseSample sample = tick_at(time);
  return motion.write(sample);
}

constexpr Duration k_45_hz{22'222'222};

// 90 frames average white noise to a third; the common error stays, in the pose and its covariance.
TEST(SmoothedMotion, KeepsErrorsThatFramesShareInItsCovariance) {
  const Vector3 common(0.003, -0.002, 0.001);
  const auto frames = drawn(90, k_45_hz, common);
  SmoothedMotion motion(frames, {});
  motion.select(at_ms(1000), at_ms(3000));
  int ticks = 0;
  for (int ms = 1200; ms <= 2800; ms += 4, ++ticks) {
    PoseSample sample = tick_at(at_ms(ms));
    ASSERT_TRUE(motion.write(sample)) << ms;
    EXPECT_EQ(sample.state, TrackState::measured);
    EXPECT_EQ(sample.frame, ReferenceFrame::robot);
    for (int axis = 0; axis < 3; ++axis) {
      const double variance = sample.covariance(axis, axis);
      EXPECT_GT(variance, k_common_m * k_common_m);
      EXPECT_LT(variance, k_common_m * k_common_m + 0.8 * k_white_m * k_white_m);
      const double off = sample.pose.translation(axis) - true_place(sample.tick)(axis);
      EXPECT_LT(std::abs(off), 2.5 * std::sqrt(variance)) << ms;
    }
    EXPECT_DOUBLE_EQ(sample.systematic(0, 0), k_common_m * k_common_m);
  }
  EXPECT_EQ(ticks, 401);
}

TEST(SmoothedMotion, AddsTheHeadsetsErrorAndTheTimeStamps) {
  auto frames = drawn(60, k_45_hz);
  SmoothedMotion before(frames, {});
  before.select(at_ms(1000), at_ms(2000));
  PoseSample without = tick_at(at_ms(1500));
  ASSERT_TRUE(before.write(without));
  for (MeasuredFrame& frame : frames) {
    frame.head_covariance(1, 1) = 1e-6;
    frame.stamp_s2 = 1e-4;
  }
  SmoothedMotion after(frames, {});
  after.select(at_ms(1000), at_ms(2000));
  PoseSample with = tick_at(at_ms(1500));
  ASSERT_TRUE(after.write(with));
  const Vector3 speed = without.velocity_m_s;
  EXPECT_NEAR(with.covariance(0, 0) - without.covariance(0, 0), 1e-4 * speed.x() * speed.x(),
              1e-12);
  EXPECT_NEAR(with.covariance(1, 1) - without.covariance(1, 1), 1e-6 + 1e-4 * speed.y() * speed.y(),
              1e-12);
}

TEST(SmoothedMotion, WritesTheTipInTheRobotsFrame) {
  auto frames = drawn(60, k_45_hz);
  const Pose T_world_robot{from_rotation_vector(Vector3(0, 0, 1)), Vector3(0.5, 0.2, 0.1)};
  for (MeasuredFrame& frame : frames) {
    frame.T_base_robot = T_world_robot;
    frame.tip.arm_m = Vector3(0, 0, -0.1);
  }
  SmoothedMotion motion(frames, {});
  motion.select(at_ms(1000), at_ms(2000));
  PoseSample sample = tick_at(at_ms(1500));
  ASSERT_TRUE(motion.write(sample));
  const Vector3 expected =
      T_world_robot.inverse() * Vector3(true_place(sample.tick) + Vector3(0, 0, -0.1));
  EXPECT_LT((sample.pose.translation - expected).norm(), 0.002);
}

TEST(SmoothedMotion, BridgesASlowCameraButNoHiddenTool) {
  const auto slow = drawn(12, milliseconds(200));
  SmoothedMotion by_slow_camera(slow, {});
  by_slow_camera.select(at_ms(1000), at_ms(3000));
  EXPECT_TRUE(covers(by_slow_camera, at_ms(2100)));
  auto hidden = slow;
  hidden[6].frames_without = 4;  // from 2.0 to 2.2 s
  SmoothedMotion of_hidden_tool(hidden, {});
  of_hidden_tool.select(at_ms(1000), at_ms(3000));
  EXPECT_TRUE(covers(of_hidden_tool, at_ms(1900)));
  EXPECT_FALSE(covers(of_hidden_tool, at_ms(2100)));
  EXPECT_TRUE(covers(of_hidden_tool, at_ms(2300)));
  const auto slower = drawn(12, milliseconds(300));
  SmoothedMotion too_slow(slower, {});
  too_slow.select(at_ms(1000), at_ms(3000));
  EXPECT_FALSE(covers(too_slow, at_ms(1450)));
}

TEST(SmoothedMotion, EndsAtARestartAndAtAStepBackInTime) {
  auto frames = drawn(60, k_45_hz);
  frames[30].restarts = true;
  const Time between = frames[30].frame.measured.time - milliseconds(5);
  SmoothedMotion restarted(frames, {});
  restarted.select(at_ms(1000), at_ms(3000));
  EXPECT_FALSE(covers(restarted, between));
  EXPECT_TRUE(covers(restarted, between + milliseconds(10)));
  frames = drawn(60, k_45_hz);
  for (std::size_t i = 30; i < frames.size(); ++i)
    frames[i].frame.measured.time = frames[i].frame.measured.time - milliseconds(400);
  SmoothedMotion stepped(frames, {});
  stepped.select(at_ms(1000), at_ms(3000));
  EXPECT_TRUE(covers(stepped, at_ms(1100)));
}

TEST(SmoothedMotion, UsesTheMarginAndNothingBeyond) {
  const auto frames = drawn(200, k_45_hz);
  SmoothedMotion motion(frames, {});
  motion.select(at_ms(2000), at_ms(3000));
  EXPECT_EQ(motion.frames_used(), 45);  // 46 to 90: 22.222222 ms apart
  EXPECT_TRUE(covers(motion, at_ms(1600)));
  EXPECT_FALSE(covers(motion, at_ms(1400)));
  EXPECT_TRUE(covers(motion, at_ms(3400)));
  EXPECT_FALSE(covers(motion, at_ms(3600)));
  const std::vector<MeasuredFrame> no_frames;
  SmoothedMotion none(no_frames, {});
  none.select(at_ms(0), at_ms(1000));
  EXPECT_FALSE(covers(none, at_ms(500)));
}

TEST(SmoothedMotion, RefusesAStrokeOfTooManyFrames) {
  const auto frames = drawn(static_cast<int>(k_stroke_frames_max) + 1, k_45_hz);
  SmoothedMotion motion(frames, {});
  try {
    motion.select(at_ms(0), at_ms(1e6));
    FAIL() << "it was smoothed";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("expected at most 8192 measured frames; --live"),
              std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace glint
