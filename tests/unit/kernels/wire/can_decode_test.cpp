// Decoders of classic CAN frames: which frames they accept, and each field of an accepted frame.
#include "kernels/wire/can_decode.hpp"

#include <gtest/gtest.h>

#include <bit>

#include "kernels/wire/bits.hpp"
#include "kernels/wire/can_frames.hpp"
#include "kernels/wire/e2e.hpp"
#include "tests/unit/kernels/wire/samples.hpp"

namespace glint::can_decode_test {
namespace {

// Returns a P01-protected frame with these eight bytes; protection overwrites checksum and counter.
CanFrame classic(std::uint64_t word, std::uint8_t length = 8) {
  CanFrame frame;
  frame.identifier = 0x1A0;
  frame.length = length;
  put_little_endian(std::span(frame.data).first(8), word);
  protect_p01(std::span(frame.data).first(length), 0x1A0, P01Mode::both, 11);
  return frame;
}

CanFrame fd(std::uint8_t length = 64) {
  CanFrame frame;
  frame.identifier = 0x1A8;
  frame.length = length;
  frame.fd = true;
  protect_p05(std::span(frame.data).first(length), 0x1A8, 200);
  return frame;
}

bool is_accepted_by_all(const CanFrame& frame) {
  const bool taken = static_cast<bool>(decode_position(frame));
  EXPECT_EQ(static_cast<bool>(decode_orientation(frame)), taken);
  EXPECT_EQ(static_cast<bool>(decode_velocity(frame)), taken);
  EXPECT_EQ(static_cast<bool>(decode_angular_velocity(frame)), taken);
  EXPECT_EQ(static_cast<bool>(decode_quality(frame)), taken);
  return taken;
}

// Each frame's checksum is valid; only its kind (length, flags) is wrong.
TEST(CanDecode, TakesEightBytesOfAClassicFrameWithAnElevenBitIdentifier) {
  EXPECT_TRUE(is_accepted_by_all(classic(0)));
  for (std::uint8_t length = 2; length <= 12; ++length)
    EXPECT_EQ(is_accepted_by_all(classic(0, length)), length == 8) << int{length};
  CanFrame flagged = classic(0);
  flagged.fd = true;
  EXPECT_FALSE(is_accepted_by_all(flagged));
  flagged = classic(0);
  flagged.extended = true;
  EXPECT_FALSE(is_accepted_by_all(flagged));
  EXPECT_EQ(decode_position(flagged).reason, Reason::frame_invalid);
}

TEST(CanDecode, TakesSixtyFourBytesOfAnFdFrameWithAnElevenBitIdentifier) {
  EXPECT_TRUE(decode_fd_pose(fd()));
  EXPECT_FALSE(decode_fd_pose(fd(48)));
  EXPECT_FALSE(decode_fd_pose(fd(63)));
  CanFrame flagged = fd();
  flagged.fd = false;
  EXPECT_FALSE(decode_fd_pose(flagged));
  flagged = fd();
  flagged.extended = true;
  EXPECT_EQ(decode_fd_pose(flagged).reason, Reason::frame_invalid);
}

TEST(CanDecode, GivesTheCounterOfEachFrame) {
  const CanFrame frame = classic(0);
  EXPECT_EQ(decode_position(frame).value.counter, 11);
  EXPECT_EQ(decode_orientation(frame).value.counter, 11);
  EXPECT_EQ(decode_velocity(frame).value.counter, 11);
  EXPECT_EQ(decode_angular_velocity(frame).value.counter, 11);
  EXPECT_EQ(decode_quality(frame).value.counter, 11);
  EXPECT_EQ(decode_fd_pose(fd()).value.quality.counter, 200);
}

// One field at a time is at its limit, and all others are zero: a wrong bit position changes the
// value.
TEST(CanDecode, ReadsEachSignedFieldFromItsOwnBits) {
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3 unit = Vector3::Unit(axis);
    for (const std::int64_t value : {1, -1, 0x7FFF, -0x8000}) {
      const auto bits = static_cast<std::uint64_t>(value);
      const CanFrame words = classic(bits_at(bits, 14 + 16 * axis, 16));
      EXPECT_EQ(decode_velocity(words).value.velocity,
                k_velocity_message.signal("X").step * static_cast<double>(value) * unit);
      EXPECT_EQ(decode_angular_velocity(words).value.velocity,
                k_angular_velocity_message.signal("X").step * static_cast<double>(value) * unit);
      EXPECT_EQ(decode_velocity(words).value.state, TrackState::none);
      const CanFrame position = classic(bits_at(bits, 12 + 17 * axis, 17));
      EXPECT_EQ(decode_position(position).value.position_m,
                k_position_message.signal("X").step * static_cast<double>(value) * unit);
      EXPECT_FALSE(decode_position(position).value.valid);
    }
  }
  const CanFrame valid = classic(bits_at(1, 63, 1));
  EXPECT_TRUE(decode_position(valid).value.valid);
  EXPECT_EQ(decode_position(valid).value.position_m, Vector3::Zero());
}

TEST(CanDecode, ReadsEachFieldOfTheQualityFromItsOwnBits) {
  const DecodedQuality none = decode_quality(classic(0)).value;
  struct Field {
    int at, width;
    double step;
    double (*value)(const DecodedQuality&);
  };
  const Field fields[] = {
      {12, 2, 1, [](const DecodedQuality& q) { return static_cast<double>(q.state); }},
      {15, 2, 1, [](const DecodedQuality& q) { return static_cast<double>(q.registration); }},
      {17, 4, 1, [](const DecodedQuality& q) { return static_cast<double>(q.markers); }},
      {21, 10, 0.01e-3, [](const DecodedQuality& q) { return q.sigma_position_m; }},
      {31, 10, 1.7453292519943295e-4,
       [](const DecodedQuality& q) { return q.sigma_orientation_rad; }},
      {41, 11, 0.2e-3, [](const DecodedQuality& q) { return q.age_s; }},
      {52, 7, 0.1e-3, [](const DecodedQuality& q) { return q.registration_rms_m; }},
      {59, 3, 1, [](const DecodedQuality& q) { return static_cast<double>(q.buttons); }}};
  for (const Field& field : fields) {
    for (int bit = 12; bit < 64; ++bit) {
      const DecodedQuality q = decode_quality(classic(bits_at(1, bit, 1))).value;
      const bool own = bit >= field.at && bit < field.at + field.width;
      const double expected = own ? field.step * (1 << (bit - field.at)) : field.value(none);
      EXPECT_NEAR(field.value(q), expected, 1e-12) << field.at << ' ' << bit;
    }
  }
}

TEST(CanDecode, ReadsTheStateFromTheLastTwoBits) {
  for (std::uint64_t state = 0; state < 4; ++state) {
    const CanFrame frame = classic(bits_at(state, 62, 2));
    EXPECT_EQ(decode_velocity(frame).value.state, static_cast<TrackState>(state));
    EXPECT_EQ(decode_angular_velocity(frame).value.state, static_cast<TrackState>(state));
    EXPECT_EQ(decode_orientation(frame).value.state, static_cast<TrackState>(state));
  }
}

// Without a pose the three components of the quaternion are undefined.
TEST(CanDecode, GivesNoRotationWithoutAPose) {
  const std::uint64_t packed = bits_at(2, 12, 2) | bits_at(5000, 14, 16) |
                               bits_at(static_cast<std::uint64_t>(-9000), 30, 16) |
                               bits_at(700, 46, 16);
  for (std::uint64_t state = 0; state < 4; ++state) {
    const Quaternion rotation =
        decode_orientation(classic(packed | bits_at(state, 62, 2))).value.rotation;
    if (state == 0 || state == 3) {
      EXPECT_EQ(rotation.coeffs(), Quaternion::Identity().coeffs());
    } else {
      EXPECT_NEAR(rotation.x(), 5000 * 2.1580187e-5, 1e-9);
      EXPECT_NEAR(rotation.y(), -9000 * 2.1580187e-5, 1e-9);
      EXPECT_NEAR(rotation.w(), 700 * 2.1580187e-5, 1e-9);
      EXPECT_GT(rotation.z(), 0.9);
    }
  }
}

TEST(Bits, OfBothByteOrdersAndBothSignsComeBack) {
  for (int width = 1; width <= 63; ++width) {
    for (int at = 0; at + width <= 64; ++at) {
      const std::uint64_t ones = ~std::uint64_t{0};
      EXPECT_EQ(unsigned_at(bits_at(ones, at, width), at, width), ones >> (64 - width));
      EXPECT_EQ(std::popcount(bits_at(ones, at, width)), width);
      EXPECT_EQ(signed_at(bits_at(ones, at, width), at, width), -1);
      EXPECT_EQ(unsigned_at(ones, at, width), ones >> (64 - width));
    }
  }
  for (std::size_t size = 1; size <= 8; ++size) {
    std::array<std::uint8_t, 8> low_first{}, high_first{};
    put_little_endian(std::span(low_first).first(size), 0x0123456789ABCDEF);
    put_big_endian(std::span(high_first).first(size), 0x0123456789ABCDEF);
    for (std::size_t i = 0; i < size; ++i) {
      EXPECT_EQ(low_first[i], 0x0123456789ABCDEF >> 8 * i & 0xFF);
      EXPECT_EQ(high_first[size - 1 - i], low_first[i]);
    }
    EXPECT_EQ(get_little_endian(std::span(low_first).first(size)),
              0x0123456789ABCDEF & (~std::uint64_t{0} >> (64 - 8 * size)));
  }
}

}  // namespace
}  // namespace glint::can_decode_test
