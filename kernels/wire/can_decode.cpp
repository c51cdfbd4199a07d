#include "kernels/wire/can_decode.hpp"

#include "kernels/wire/bits.hpp"
#include "kernels/wire/can_frames.hpp"
#include "kernels/wire/e2e.hpp"
#include "kernels/wire/smallest_three.hpp"

namespace glint {
namespace {

constexpr double k_fd_rotation_norm_min = 0.5;  // a smaller norm is a frame without a pose

// Returns the eight bytes as one word, or Reason::frame_invalid.
Result<std::uint64_t> checked_word(const CanFrame& frame) {
  const bool good =
      !frame.fd && !frame.extended && frame.length == 8 &&
      check_p01(frame.bytes(), static_cast<std::uint16_t>(frame.identifier), P01Mode::both);
  if (!good) return {0, Reason::frame_invalid};
  return {get_little_endian(frame.bytes()), Reason::none};
}

TrackState state_of(std::uint64_t word) { return static_cast<TrackState>(word >> 62); }

std::uint8_t counter_of(std::uint64_t word) {
  return static_cast<std::uint8_t>(unsigned_at(word, 8, 4));
}

Vector3 vector_at(std::uint64_t word, int at, int width, double step) {
  return step * Vector3(static_cast<double>(signed_at(word, at, width)),
                        static_cast<double>(signed_at(word, at + width, width)),
                        static_cast<double>(signed_at(word, at + 2 * width, width)));
}

double value_or_unknown(std::uint64_t value, std::uint64_t over, double step) {
  return value == over ? -1 : static_cast<double>(value) * step;
}

Result<DecodedVelocity> velocity(const CanFrame& frame, double step) {
  const Result<std::uint64_t> word = checked_word(frame);
  if (!word) return {{}, word.reason};
  return {{counter_of(word.value), state_of(word.value), vector_at(word.value, 14, 16, step)},
          Reason::none};
}

}  // namespace

Result<DecodedPosition> decode_position(const CanFrame& frame) noexcept {
  const Result<std::uint64_t> word = checked_word(frame);
  if (!word) return {{}, word.reason};
  return {{counter_of(word.value), word.value >> 63 != 0,
           vector_at(word.value, 12, 17, k_can_position_step_m)},
          Reason::none};
}

Result<DecodedOrientation> decode_orientation(const CanFrame& frame) noexcept {
  const Result<std::uint64_t> word = checked_word(frame);
  if (!word) return {{}, word.reason};
  DecodedOrientation result;
  result.counter = counter_of(word.value);
  result.state = state_of(word.value);
  if (result.state != TrackState::measured && result.state != TrackState::predicted)
    return {result, Reason::none};
  SmallestThree packed;
  packed.left_out = static_cast<std::uint8_t>(unsigned_at(word.value, 12, 2));
  for (int i = 0; i < 3; ++i)
    packed.component[static_cast<std::size_t>(i)] =
        static_cast<std::int16_t>(signed_at(word.value, 14 + 16 * i, 16));
  result.rotation = from_smallest_three(packed);
  return {result, Reason::none};
}

Result<DecodedVelocity> decode_velocity(const CanFrame& frame) noexcept {
  return velocity(frame, k_can_velocity_step_m_s);
}

Result<DecodedVelocity> decode_angular_velocity(const CanFrame& frame) noexcept {
  return velocity(frame, k_can_angular_velocity_step_rad_s);
}

Result<DecodedQuality> decode_quality(const CanFrame& frame) noexcept {
  const Result<std::uint64_t> checked = checked_word(frame);
  if (!checked) return {{}, checked.reason};
  const std::uint64_t word = checked.value;
  DecodedQuality q;
  q.counter = counter_of(word);
  q.state = static_cast<TrackState>(unsigned_at(word, 12, 2));
  q.registration = static_cast<RegistrationState>(unsigned_at(word, 15, 2));
  q.markers = static_cast<std::uint8_t>(unsigned_at(word, 17, 4));
  q.sigma_position_m =
      value_or_unknown(unsigned_at(word, 21, 10), k_can_sigma_over, k_can_sigma_position_step_m);
  q.sigma_orientation_rad = value_or_unknown(unsigned_at(word, 31, 10), k_can_sigma_over,
                                             k_can_sigma_orientation_step_rad);
  q.age_s = value_or_unknown(unsigned_at(word, 41, 11), k_can_age_over, k_can_age_step_s);
  q.registration_rms_m =
      value_or_unknown(unsigned_at(word, 52, 7), k_can_rms_over, k_can_rms_step_m);
  q.buttons = static_cast<std::uint8_t>(unsigned_at(word, 59, 3));
  return {q, Reason::none};
}

Result<DecodedFdPose> decode_fd_pose(const CanFrame& frame) noexcept {
  const bool good = frame.fd && !frame.extended && frame.length == 64 &&
                    check_p05(frame.bytes(), static_cast<std::uint16_t>(frame.identifier));
  if (!good) return {{}, Reason::frame_invalid};
  const auto word = [&](std::size_t at, std::size_t size) {
    return get_little_endian(frame.bytes().subspan(at, size));
  };
  const auto vector = [&](std::size_t at, std::size_t size, double step) {
    Vector3 result;
    for (std::size_t i = 0; i < 3; ++i)
      result[static_cast<int>(i)] =
          step *
          static_cast<double>(signed_at(word(at + i * size, size), 0, static_cast<int>(8 * size)));
    return result;
  };
  DecodedFdPose pose;
  DecodedQuality& q = pose.quality;
  q.counter = frame.data[2];
  q.state = static_cast<TrackState>(frame.data[3] & 3U);
  q.registration = static_cast<RegistrationState>(frame.data[3] >> 3 & 3U);
  q.buttons = static_cast<std::uint8_t>(frame.data[3] >> 5);
  q.sigma_position_m =
      value_or_unknown(word(44, 2), k_can_fd_word_over, k_can_sigma_position_step_m);
  q.sigma_orientation_rad =
      value_or_unknown(word(46, 2), k_can_fd_word_over, k_can_sigma_orientation_step_rad);
  q.age_s = value_or_unknown(word(48, 2), k_can_fd_word_over, k_can_fd_age_step_s);
  q.markers = frame.data[50];
  q.registration_rms_m = value_or_unknown(word(51, 1), k_can_fd_byte_over, k_can_rms_step_m);
  pose.position_m = vector(4, 4, k_can_fd_position_step_m);
  const Vector3 xyz = vector(16, 4, k_can_fd_rotation_step);
  const Quaternion rotation(
      k_can_fd_rotation_step * static_cast<double>(signed_at(word(28, 4), 0, 32)), xyz.x(), xyz.y(),
      xyz.z());
  if (rotation.norm() > k_fd_rotation_norm_min) pose.rotation = rotation.normalized();
  pose.velocity_m_s = vector(32, 2, k_can_velocity_step_m_s);
  pose.angular_velocity_rad_s = vector(38, 2, k_can_angular_velocity_step_rad_s);
  pose.unix_measurement_ns = static_cast<std::int64_t>(word(52, 8));
  pose.frame_sequence = static_cast<std::uint32_t>(word(60, 4));
  return {pose, Reason::none};
}

}  // namespace glint
