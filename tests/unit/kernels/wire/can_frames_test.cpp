#include "kernels/wire/can_frames.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <set>

#include "kernels/wire/can_decode.hpp"
#include "tests/unit/kernels/wire/hex.hpp"
#include "tests/unit/kernels/wire/samples.hpp"

namespace glint::can_frames_test {
namespace {

constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();
constexpr double k_half = 0.5 + 1e-6;  // half a step plus rounding of doubles

CanFrames packed(const PoseSample& sample, const CanPacking& packing = {}) {
  CanFrames frames;
  add_pose_frames(sample, packing, frames);
  return frames;
}

PoseSample still_sample() {
  PoseSample s;
  s.state = TrackState::measured;
  s.tick_number = 5;
  s.tick = {1'020'000'000};
  s.measurement = {1'000'000'000};
  s.pose.translation = {1.23455, -0.98765, 0.321};
  s.pose.rotation = Quaternion(.73029674, .18257419, .36514837, .54772256);
  return s;
}

TEST(CanFrames, GiveTheDocumentedVectors) {
  const CanFrames frames = packed(still_sample());
  ASSERT_EQ(frames.count, 5);
  EXPECT_EQ(frames.items[0].identifier, 0x1A0U);
  EXPECT_EQ(hex_of(frames.items[0].bytes()), "663507E65A364586");
  EXPECT_EQ(frames.items[1].identifier, 0x1A1U);
  EXPECT_EQ(hex_of(frames.items[1].bytes()), "743543488650C998");
}

TEST(CanFrames, ComeBackWithinHalfAStep) {
  std::mt19937 random(11);
  for (int i = 0; i < 2000; ++i) {
    const PoseSample s = random_sample(random);
    const CanFrames frames = packed(s);
    ASSERT_EQ(frames.count, 5);
    const auto position = decode_position(frames.items[0]);
    const auto orientation = decode_orientation(frames.items[1]);
    const auto velocity = decode_velocity(frames.items[2]);
    const auto angular = decode_angular_velocity(frames.items[3]);
    const auto quality = decode_quality(frames.items[4]);
    ASSERT_TRUE(position && orientation && velocity && angular && quality);
    EXPECT_TRUE(position.value.valid);
    EXPECT_LE((position.value.position_m - s.pose.translation).cwiseAbs().maxCoeff(),
              k_half * k_position_message.signal("X").step);
    EXPECT_GT(std::abs(orientation.value.rotation.dot(s.pose.rotation)), 1 - 1e-9);
    EXPECT_LE((velocity.value.velocity - s.velocity_m_s).cwiseAbs().maxCoeff(),
              k_half * k_velocity_message.signal("X").step);
    EXPECT_LE((angular.value.velocity - s.angular_velocity_rad_s).cwiseAbs().maxCoeff(),
              k_half * k_angular_velocity_message.signal("X").step);
    const DecodedQuality& q = quality.value;
    EXPECT_EQ(q.state, s.state);
    EXPECT_EQ(velocity.value.state, s.state);
    EXPECT_EQ(angular.value.state, s.state);
    EXPECT_EQ(orientation.value.state, s.state);
    EXPECT_EQ(q.registration, s.registration);
    EXPECT_EQ(q.markers, std::popcount(s.marker_mask));
    EXPECT_EQ(q.buttons, s.buttons);
    EXPECT_NEAR(q.sigma_position_m, s.sigma_position_m,
                k_half * k_quality_message.signal("SigmaPosition").step);
    EXPECT_NEAR(q.sigma_orientation_rad, s.sigma_orientation_rad,
                k_half * k_quality_message.signal("SigmaOrientation").step);
    EXPECT_NEAR(q.age_s, s.age().seconds(), k_half * k_quality_message.signal("Age").step);
    EXPECT_NEAR(q.registration_rms_m, s.registration_rms_m,
                k_half * k_quality_message.signal("RegistrationRms").step);
  }
}

TEST(CanFrames, OfOneEstimateShareTheCounter) {
  PoseSample s = still_sample();
  for (const std::uint32_t tick : {0U, 1U, 14U, 15U, 16U, 4000000000U}) {
    s.tick_number = tick;
    const CanFrames frames = packed(s);
    for (const CanFrame& frame : frames.frames()) EXPECT_EQ(frame.data[1] & 0xFU, tick % 15);
  }
}

TEST(CanFrames, AreRejectedForEachFlippedBit) {
  std::mt19937 random(12);
  for (int i = 0; i < 20; ++i) {
    const CanFrames frames = packed(random_sample(random));
    for (int bit = 0; bit < 64; ++bit) {
      EXPECT_FALSE(decode_position(flipped(frames.items[0], bit)));
      EXPECT_FALSE(decode_orientation(flipped(frames.items[1], bit)));
      EXPECT_FALSE(decode_velocity(flipped(frames.items[2], bit)));
      EXPECT_FALSE(decode_angular_velocity(flipped(frames.items[3], bit)));
      EXPECT_FALSE(decode_quality(flipped(frames.items[4], bit)));
    }
  }
}

TEST(CanFrames, AreRejectedUnderAnotherIdentifier) {
  CanFrame frame = packed(still_sample()).items[0];
  frame.identifier = 0x1B0;
  EXPECT_FALSE(decode_position(frame));
}

TEST(CanFrames, SendAPositionOutOfRangeAsInvalidAndNeverWrapIt) {
  PoseSample s = still_sample();
  for (const double bad : {3.27678, -3.27683, 10.0, 1e9, -1e300, k_nan}) {
    for (int axis = 0; axis < 3; ++axis) {
      s.pose.translation = Vector3(0.1, 0.2, 0.3);
      s.pose.translation[axis] = bad;
      const auto position = decode_position(packed(s).items[0]);
      ASSERT_TRUE(position);
      EXPECT_FALSE(position.value.valid);
      EXPECT_EQ(position.value.position_m, Vector3::Zero());
    }
  }
  s.pose.translation = Vector3(3.27675, -3.2768, 0);
  const auto edge = decode_position(packed(s).items[0]);
  EXPECT_TRUE(edge.value.valid);
  EXPECT_NEAR(edge.value.position_m.x(), 3.27675, 1e-12);
  EXPECT_NEAR(edge.value.position_m.y(), -3.2768, 1e-12);
}

TEST(CanFrames, SendVelocitiesAndRotationsOutOfRangeWithStateNone) {
  PoseSample s = still_sample();
  for (const double bad : {3.28, -3.28, 1e300, k_nan}) {
    s.velocity_m_s = Vector3(0, bad, 0);
    s.angular_velocity_rad_s = Vector3(0, 0, 10 * bad);
    s.pose.rotation.w() = bad;
    const CanFrames frames = packed(s);
    EXPECT_EQ(decode_velocity(frames.items[2]).value.state, TrackState::none);
    EXPECT_EQ(decode_velocity(frames.items[2]).value.velocity, Vector3::Zero());
    EXPECT_EQ(decode_angular_velocity(frames.items[3]).value.state, TrackState::none);
    EXPECT_EQ(decode_orientation(frames.items[1]).value.state, TrackState::none);
    EXPECT_EQ(decode_quality(frames.items[4]).value.state, TrackState::measured);
  }
}

TEST(CanFrames, SendUncertaintyBeyondItsFieldAsUnknown) {
  PoseSample s = still_sample();
  s.sigma_position_m = 0.5;
  s.sigma_orientation_rad = 3;
  s.registration_rms_m = k_nan;
  s.measurement = s.tick - milliseconds(410);
  const DecodedQuality q = decode_quality(packed(s).items[4]).value;
  EXPECT_EQ(q.sigma_position_m, -1);
  EXPECT_EQ(q.sigma_orientation_rad, -1);
  EXPECT_EQ(q.registration_rms_m, -1);
  EXPECT_EQ(q.age_s, -1);
  s.measurement = s.tick + milliseconds(1);  // measured after its tick: a clock error
  EXPECT_EQ(decode_quality(packed(s).items[4]).value.age_s, -1);
}

TEST(CanFrames, SendALostToolWithoutAPose) {
  PoseSample s = still_sample();
  s.state = TrackState::lost;
  s.buttons = 5;
  const CanFrames frames = packed(s);
  EXPECT_FALSE(decode_position(frames.items[0]).value.valid);
  EXPECT_EQ(decode_position(frames.items[0]).value.position_m, Vector3::Zero());
  EXPECT_EQ(decode_orientation(frames.items[1]).value.state, TrackState::lost);
  EXPECT_EQ(decode_velocity(frames.items[2]).value.state, TrackState::lost);
  const DecodedQuality q = decode_quality(frames.items[4]).value;
  EXPECT_EQ(q.state, TrackState::lost);
  EXPECT_EQ(q.buttons, 5);
  EXPECT_EQ(q.sigma_position_m, -1);
  EXPECT_EQ(q.age_s, -1);
}

TEST(CanFrames, GiveEachToolAndFrameItsOwnIdentifier) {
  std::set<std::uint32_t> seen;
  PoseSample s = still_sample();
  CanPacking packing;
  packing.base_identifier = k_can_base_max;
  for (const CanFormat format : {CanFormat::classic, CanFormat::fd}) {
    packing.format = format;
    for (std::uint8_t tool = 0; tool < k_tools_max; ++tool) {
      s.tool = tool;
      const CanFrames frames = packed(s, packing);
      for (const CanFrame& frame : frames.frames()) {
        EXPECT_TRUE(seen.insert(frame.identifier).second);
        EXPECT_EQ((frame.identifier - k_can_base_max) / 16, tool);
      }
    }
  }
  EXPECT_EQ(seen.size(), 16U * 6U);
  EXPECT_LE(*seen.rbegin(), k_can_identifier_max);
}

TEST(CanFrames, CountWhatDoesNotFitInsteadOfOverflowing) {
  CanFrames frames;
  for (int i = 0; i < 100; ++i) add_pose_frames(still_sample(), {}, frames);
  EXPECT_EQ(frames.count, k_can_frames_max);
  EXPECT_EQ(frames.dropped, 500U - k_can_frames_max);
  CanFrames none;
  PoseSample s = still_sample();
  s.tool = k_tools_max;
  add_pose_frames(s, {}, none);
  EXPECT_EQ(none.count, 0);
  EXPECT_EQ(none.dropped, 1U);
}

}  // namespace
}  // namespace glint::can_frames_test
