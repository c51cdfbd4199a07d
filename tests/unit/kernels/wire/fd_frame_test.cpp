#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>

#include "kernels/wire/can_decode.hpp"
#include "kernels/wire/can_frames.hpp"
#include "tests/unit/kernels/wire/hex.hpp"
#include "tests/unit/kernels/wire/samples.hpp"

namespace glint::fd_frame_test {
namespace {

constexpr double k_half = 0.5 + 1e-6;

CanFrame packed(const PoseSample& sample, std::int64_t unix_offset_ns = 0) {
  CanPacking packing;
  packing.format = CanFormat::fd;
  packing.unix_offset_ns = unix_offset_ns;
  CanFrames frames;
  add_pose_frames(sample, packing, frames);
  EXPECT_EQ(frames.count, 1);
  return frames.items[0];
}

TEST(FdFrame, ComesBackWithinHalfAStep) {
  constexpr std::int64_t k_offset = 1'700'000'000'000'000'123;
  std::mt19937 random(21);
  for (int i = 0; i < 2000; ++i) {
    const PoseSample s = random_sample(random);
    const CanFrame frame = packed(s, k_offset);
    EXPECT_EQ(frame.identifier, 0x1A8U + 16U * s.tool);
    const auto decoded = decode_fd_pose(frame);
    ASSERT_TRUE(decoded);
    const DecodedFdPose& pose = decoded.value;
    EXPECT_LE((pose.position_m - s.pose.translation).cwiseAbs().maxCoeff(),
              k_half * k_fd_message.signal("X").step);
    EXPECT_LE((pose.rotation.coeffs() - s.pose.rotation.coeffs()).cwiseAbs().maxCoeff(),
              4 * k_fd_message.signal("RotationX").step);
    EXPECT_LE((pose.velocity_m_s - s.velocity_m_s).cwiseAbs().maxCoeff(),
              k_half * k_velocity_message.signal("X").step);
    EXPECT_LE((pose.angular_velocity_rad_s - s.angular_velocity_rad_s).cwiseAbs().maxCoeff(),
              k_half * k_angular_velocity_message.signal("X").step);
    EXPECT_EQ(pose.unix_measurement_ns, s.measurement.nanoseconds + k_offset);
    EXPECT_EQ(pose.frame_sequence, s.frame_sequence);
    const DecodedQuality& q = pose.quality;
    EXPECT_EQ(q.counter, s.tick_number % 256);
    EXPECT_EQ(q.state, s.state);
    EXPECT_EQ(q.registration, s.registration);
    EXPECT_EQ(q.buttons, s.buttons);
    EXPECT_EQ(q.markers, std::popcount(s.marker_mask));
    EXPECT_NEAR(q.sigma_position_m, s.sigma_position_m,
                k_half * k_quality_message.signal("SigmaPosition").step);
    EXPECT_NEAR(q.sigma_orientation_rad, s.sigma_orientation_rad,
                k_half * k_quality_message.signal("SigmaOrientation").step);
    EXPECT_NEAR(q.age_s, s.age().seconds(), k_half * k_fd_message.signal("Age").step);
    EXPECT_NEAR(q.registration_rms_m, s.registration_rms_m,
                k_half * k_quality_message.signal("RegistrationRms").step);
  }
}

// Bytes worked out by hand from the table in can_frames.hpp; the checksum is from an independent
// CRC.
TEST(FdFrame, HasItsDocumentedBytes) {
  PoseSample s;
  s.state = TrackState::measured;
  s.registration = RegistrationState::given;
  s.buttons = 3;
  s.tick_number = 0x107;
  s.frame_sequence = 0x04030201;
  s.marker_mask = 0b10110;
  s.measurement = {0x1122};
  s.tick = s.measurement + milliseconds(20);
  s.pose.translation = Vector3(0.000258, -0.000001, 1);
  s.velocity_m_s = Vector3(0.0001, -0.0001, 0.0258);
  s.angular_velocity_rad_s = Vector3(0.001, -0.001, 0.258);
  s.sigma_position_m = 0.00258;
  s.sigma_orientation_rad = 0.01 * 3.141592653589793 / 180;
  s.registration_rms_m = 0.0015;
  const std::string hex = hex_of(packed(s).bytes());
  EXPECT_EQ(hex.substr(4),
            "07"
            "6A"
            "02010000"
            "FFFFFFFF"
            "40420F00"
            "00000000"
            "00000000"
            "00000000"
            "00000040"
            "0100"
            "FFFF"
            "0201"
            "0100"
            "FFFF"
            "0201"
            "0201"
            "0100"
            "C800"
            "03"
            "0F"
            "2211000000000000"
            "01020304");
}

TEST(FdFrame, IsRejectedForEachFlippedBit) {
  std::mt19937 random(22);
  const CanFrame frame = packed(random_sample(random));
  for (int bit = 0; bit < 512; ++bit) EXPECT_FALSE(decode_fd_pose(flipped(frame, bit))) << bit;
  CanFrame other = frame;
  other.identifier += 16;
  EXPECT_FALSE(decode_fd_pose(other));
  CanFrame shorter = frame;
  shorter.length = 48;
  EXPECT_FALSE(decode_fd_pose(shorter));
}

TEST(FdFrame, SendsAnythingOutOfRangeWithStateNoneAndZeros) {
  std::mt19937 random(23);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (int part = 0; part < 5; ++part) {
    PoseSample s = random_sample(random);
    if (part == 0) s.pose.translation.x() = 2147.484;
    if (part == 1) s.velocity_m_s.y() = -3.28;
    if (part == 2) s.angular_velocity_rad_s.z() = 32.768;
    if (part == 3) s.pose.rotation.w() = 2;
    if (part == 4) s.pose.translation.z() = nan;
    const auto decoded = decode_fd_pose(packed(s));
    ASSERT_TRUE(decoded);
    EXPECT_EQ(decoded.value.quality.state, TrackState::none) << part;
    EXPECT_EQ(decoded.value.position_m, Vector3::Zero());
    EXPECT_EQ(decoded.value.velocity_m_s, Vector3::Zero());
    EXPECT_EQ(decoded.value.rotation.coeffs(), Quaternion::Identity().coeffs());
    EXPECT_EQ(decoded.value.frame_sequence, s.frame_sequence);
  }
}

TEST(FdFrame, SendsATimeBefore1970AsUnknown) {
  PoseSample s;
  s.measurement = {-5};
  EXPECT_EQ(decode_fd_pose(packed(s)).value.unix_measurement_ns, 0);
  s.measurement = {std::numeric_limits<std::int64_t>::max()};
  EXPECT_EQ(decode_fd_pose(packed(s, 10)).value.unix_measurement_ns, 0);
}

TEST(FdFrame, SendsTheLastTimeThatAnInt64Holds) {
  constexpr std::int64_t k_last = std::numeric_limits<std::int64_t>::max();
  PoseSample s;
  s.measurement = {k_last - 10};
  EXPECT_EQ(decode_fd_pose(packed(s, 10)).value.unix_measurement_ns, k_last);
  EXPECT_EQ(decode_fd_pose(packed(s, 11)).value.unix_measurement_ns, 0);
  s.measurement = {0};
  EXPECT_EQ(decode_fd_pose(packed(s, 0)).value.unix_measurement_ns, 0);
  EXPECT_EQ(decode_fd_pose(packed(s, 1)).value.unix_measurement_ns, 1);
}

// The quaternion is not of unit length, but each of its components fits its field.
TEST(FdFrame, SendsWhatIsNoUnitQuaternionWithStateNone) {
  std::mt19937 random(24);
  PoseSample s = random_sample(random);
  s.pose.rotation.coeffs() *= 0.9;
  const auto decoded = decode_fd_pose(packed(s));
  ASSERT_TRUE(decoded);
  EXPECT_EQ(decoded.value.quality.state, TrackState::none);
  EXPECT_EQ(decoded.value.position_m, Vector3::Zero());
}

TEST(FdFrame, SendsALostToolWithoutAPoseAndItsFiguresAsUnknown) {
  std::mt19937 random(25);
  PoseSample s = random_sample(random);
  s.state = TrackState::lost;
  s.buttons = 5;
  const DecodedFdPose pose = decode_fd_pose(packed(s)).value;
  EXPECT_EQ(pose.quality.state, TrackState::lost);
  EXPECT_EQ(pose.quality.buttons, 5);
  EXPECT_EQ(pose.quality.registration, s.registration);
  EXPECT_EQ(pose.position_m, Vector3::Zero());
  EXPECT_EQ(pose.velocity_m_s, Vector3::Zero());
  EXPECT_EQ(pose.angular_velocity_rad_s, Vector3::Zero());
  EXPECT_EQ(pose.rotation.coeffs(), Quaternion::Identity().coeffs());
  EXPECT_EQ(pose.quality.sigma_position_m, -1);
  EXPECT_EQ(pose.quality.sigma_orientation_rad, -1);
  EXPECT_EQ(pose.quality.age_s, -1);
  EXPECT_NEAR(pose.quality.registration_rms_m, s.registration_rms_m,
              k_half * k_quality_message.signal("RegistrationRms").step);
}

// All ones mean "this or more"; the value below is the largest that is encoded exactly.
TEST(FdFrame, SendsFiguresBeyondTheirFieldsAsUnknown) {
  std::mt19937 random(26);
  for (const bool beyond : {false, true}) {
    const double last = beyond ? 0xFFFF : 0xFFFE;
    PoseSample s = random_sample(random);
    s.sigma_position_m = last * k_quality_message.signal("SigmaPosition").step;
    s.sigma_orientation_rad = last * k_quality_message.signal("SigmaOrientation").step;
    s.measurement = s.tick - microseconds(100) * static_cast<std::int64_t>(last);
    s.registration_rms_m =
        (beyond ? 0xFF : 0xFE) * k_quality_message.signal("RegistrationRms").step;
    const DecodedQuality q = decode_fd_pose(packed(s)).value.quality;
    EXPECT_NEAR(q.sigma_position_m, beyond ? -1 : s.sigma_position_m, 1e-12);
    EXPECT_NEAR(q.sigma_orientation_rad, beyond ? -1 : s.sigma_orientation_rad, 1e-12);
    EXPECT_NEAR(q.age_s, beyond ? -1 : last * k_fd_message.signal("Age").step, 1e-9);
    EXPECT_NEAR(q.registration_rms_m, beyond ? -1 : s.registration_rms_m, 1e-12);
  }
}

CanFrame packed_covariance(const PoseSample& sample) {
  CanFrames frames;
  add_pose_frames(sample, {.format = CanFormat::fd_covariance}, frames);
  EXPECT_EQ(frames.count, 2);
  EXPECT_EQ(frames.items[0].data, packed(sample).data) << "the pose's frame is unchanged";
  return frames.items[1];
}

Matrix6 random_covariance(std::mt19937& random, double size) {
  std::normal_distribution<double> normal;
  Matrix6 factor;
  for (int i = 0; i < 36; ++i) factor(i / 6, i % 6) = size * normal(random);
  return factor * factor.transpose();
}

TEST(CovarianceFrame, ComesBackWithinAStepOfEachDeviation) {
  constexpr const CanMessageLayout& m = k_covariance_message;
  std::mt19937 random(22);
  for (int i = 0; i < 2000; ++i) {
    PoseSample s = random_sample(random);
    s.covariance = random_covariance(random, 0.01);
    const CanFrame frame = packed_covariance(s);
    EXPECT_EQ(frame.length, 48);
    EXPECT_EQ(frame.identifier, k_can_base_default + k_can_tool_stride * s.tool + 9);
    const auto decoded = decode_covariance(frame);
    ASSERT_TRUE(decoded);
    EXPECT_EQ(decoded.value.counter, s.tick_number % 256);
    EXPECT_EQ(decoded.value.state, s.state);
    ASSERT_TRUE(decoded.value.known);
    for (int row = 0; row < 6; ++row) {
      for (int column = 0; column < 6; ++column) {
        const auto step = [](int axis) {
          return axis < 3 ? m.signal("SigmaX").step : m.signal("SigmaRotationX").step;
        };
        const double a = std::sqrt(s.covariance(row, row));
        const double b = std::sqrt(s.covariance(column, column));
        const double near =
            step(row) * b + step(column) * a + a * b * can_table::k_correlation_step;
        EXPECT_NEAR(decoded.value.covariance(row, column), s.covariance(row, column), near)
            << row << ", " << column;
      }
    }
  }
}

TEST(CovarianceFrame, HasNoCovarianceWithoutAPose) {
  std::mt19937 random(23);
  PoseSample s = random_sample(random);
  s.covariance = random_covariance(random, 0.01);
  for (const TrackState state : {TrackState::none, TrackState::lost}) {
    s.state = state;
    const auto decoded = decode_covariance(packed_covariance(s));
    ASSERT_TRUE(decoded);
    EXPECT_EQ(decoded.value.state, state);
    EXPECT_FALSE(decoded.value.known);
  }
}

TEST(CovarianceFrame, IsUnknownBeyondItsFieldsAndForNoCovariance) {
  std::mt19937 random(24);
  PoseSample s = random_sample(random);
  for (const double variance : {1.0, -1e-9, std::numeric_limits<double>::quiet_NaN(),
                                std::numeric_limits<double>::infinity()}) {
    s.covariance = random_covariance(random, 0.01);
    s.covariance(1, 1) = variance;  // a standard deviation of a metre exceeds 0.655 m
    const auto decoded = decode_covariance(packed_covariance(s));
    ASSERT_TRUE(decoded);
    EXPECT_FALSE(decoded.value.known) << variance;
  }
}

TEST(CovarianceFrame, IsRefusedWithAFlippedBit) {
  std::mt19937 random(25);
  PoseSample s = random_sample(random);
  s.covariance = random_covariance(random, 0.01);
  const CanFrame frame = packed_covariance(s);
  for (int bit = 0; bit < 8 * frame.length; ++bit) {
    CanFrame wrong = frame;
    wrong.data[static_cast<std::size_t>(bit / 8)] ^= static_cast<std::uint8_t>(1 << bit % 8);
    EXPECT_FALSE(decode_covariance(wrong)) << bit;
  }
  CanFrame wrong = frame;
  wrong.length = 64;
  EXPECT_FALSE(decode_covariance(wrong));
}

}  // namespace
}  // namespace glint::fd_frame_test
