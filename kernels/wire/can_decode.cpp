#include "kernels/wire/can_decode.hpp"

#include <array>
#include <cstddef>

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

std::uint64_t raw_of(std::uint64_t word, const CanSignal& signal) {
  return unsigned_at(word, signal.field.start, signal.field.width);
}

TrackState state_of(std::uint64_t word) {
  return static_cast<TrackState>(raw_of(word, k_velocity_message.signal("State")));
}

std::uint8_t counter_of(std::uint64_t word) {
  return static_cast<std::uint8_t>(raw_of(word, k_velocity_message.signal("Counter")));
}

Vector3 vector_of(std::uint64_t word, std::span<const CanSignal, 3> axes) {
  const auto value = [&](const CanSignal& axis) {
    return static_cast<double>(signed_at(word, axis.field.start, axis.field.width));
  };
  return axes[0].step * Vector3(value(axes[0]), value(axes[1]), value(axes[2]));
}

double value_or_unknown(std::uint64_t value, const CanSignal& signal) {
  return value == signal.field.all_ones() ? -1 : static_cast<double>(value) * signal.step;
}

Result<DecodedVelocity> velocity(const CanFrame& frame, std::span<const CanSignal, 3> axes) {
  const Result<std::uint64_t> word = checked_word(frame);
  if (!word) return {{}, word.reason};
  return {{counter_of(word.value), state_of(word.value), vector_of(word.value, axes)},
          Reason::none};
}

}  // namespace

Result<DecodedPosition> decode_position(const CanFrame& frame) noexcept {
  const Result<std::uint64_t> word = checked_word(frame);
  if (!word) return {{}, word.reason};
  return {{counter_of(word.value), raw_of(word.value, k_position_message.signal("Valid")) != 0,
           vector_of(word.value, k_position_message.signals_from<3>("X"))},
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
  packed.left_out =
      static_cast<std::uint8_t>(raw_of(word.value, k_orientation_message.signal("LeftOut")));
  constexpr std::span<const CanSignal, 3> axes =
      k_orientation_message.signals_from<3>("Component0");
  for (std::size_t i = 0; i < 3; ++i)
    packed.component[i] =
        static_cast<std::int16_t>(signed_at(word.value, axes[i].field.start, axes[i].field.width));
  result.rotation = from_smallest_three(packed);
  return {result, Reason::none};
}

Result<DecodedVelocity> decode_velocity(const CanFrame& frame) noexcept {
  return velocity(frame, k_velocity_message.signals_from<3>("X"));
}

Result<DecodedVelocity> decode_angular_velocity(const CanFrame& frame) noexcept {
  return velocity(frame, k_angular_velocity_message.signals_from<3>("X"));
}

Result<DecodedQuality> decode_quality(const CanFrame& frame) noexcept {
  const Result<std::uint64_t> checked = checked_word(frame);
  if (!checked) return {{}, checked.reason};
  constexpr const CanMessageLayout& m = k_quality_message;
  const auto raw = [&](const CanSignal& signal) { return raw_of(checked.value, signal); };
  const auto value = [&](const CanSignal& signal) { return value_or_unknown(raw(signal), signal); };
  DecodedQuality q;
  q.counter = counter_of(checked.value);
  q.state = static_cast<TrackState>(raw(m.signal("State")) & 3U);
  q.registration = static_cast<RegistrationState>(raw(m.signal("Registration")));
  q.markers = static_cast<std::uint8_t>(raw(m.signal("Markers")));
  q.sigma_position_m = value(m.signal("SigmaPosition"));
  q.sigma_orientation_rad = value(m.signal("SigmaOrientation"));
  q.age_s = value(m.signal("Age"));
  q.registration_rms_m = value(m.signal("RegistrationRms"));
  q.buttons = static_cast<std::uint8_t>(raw(m.signal("Buttons")));
  return {q, Reason::none};
}

Result<DecodedFdPose> decode_fd_pose(const CanFrame& frame) noexcept {
  const bool good = frame.fd && !frame.extended && frame.length == 64 &&
                    check_p05(frame.bytes(), static_cast<std::uint16_t>(frame.identifier));
  if (!good) return {{}, Reason::frame_invalid};
  constexpr const CanMessageLayout& m = k_fd_message;
  const auto raw = [&](const CanSignal& signal) { return unsigned_of(frame.bytes(), signal); };
  const auto value = [&](const CanSignal& signal) { return value_or_unknown(raw(signal), signal); };
  const auto number = [&](const CanSignal& signal) {
    return signal.step * static_cast<double>(signed_of(frame.bytes(), signal));
  };
  const auto vector = [&](std::span<const CanSignal, 3> axes) {
    return Vector3(number(axes[0]), number(axes[1]), number(axes[2]));
  };
  DecodedFdPose pose;
  DecodedQuality& q = pose.quality;
  q.counter = static_cast<std::uint8_t>(raw(m.signal("Counter")));
  q.state = static_cast<TrackState>(raw(m.signal("State")) & 3U);
  q.registration = static_cast<RegistrationState>(raw(m.signal("Registration")));
  q.buttons = static_cast<std::uint8_t>(raw(m.signal("Buttons")));
  q.sigma_position_m = value(m.signal("SigmaPosition"));
  q.sigma_orientation_rad = value(m.signal("SigmaOrientation"));
  q.age_s = value(m.signal("Age"));
  q.markers = static_cast<std::uint8_t>(raw(m.signal("Markers")));
  q.registration_rms_m = value(m.signal("RegistrationRms"));
  pose.position_m = vector(m.signals_from<3>("X"));
  const Vector3 xyz = vector(m.signals_from<3>("RotationX"));
  const Quaternion rotation(number(m.signal("RotationW")), xyz.x(), xyz.y(), xyz.z());
  if (rotation.norm() > k_fd_rotation_norm_min) pose.rotation = rotation.normalized();
  pose.velocity_m_s = vector(m.signals_from<3>("VelocityX"));
  pose.angular_velocity_rad_s = vector(m.signals_from<3>("AngularVelocityX"));
  pose.unix_measurement_ns = static_cast<std::int64_t>(raw(m.signal("MeasurementTime")));
  pose.frame_sequence = static_cast<std::uint32_t>(raw(m.signal("FrameSequence")));
  return {pose, Reason::none};
}

Result<DecodedCovariance> decode_covariance(const CanFrame& frame) noexcept {
  constexpr const CanMessageLayout& m = k_covariance_message;
  const bool good = frame.fd && !frame.extended && frame.length == m.bytes &&
                    check_p05(frame.bytes(), static_cast<std::uint16_t>(frame.identifier));
  if (!good) return {{}, Reason::frame_invalid};
  constexpr auto sigmas = m.signals_from<can_table::k_pose_axes>(can_table::k_covariance_sigmas[0]);
  constexpr auto correlations =
      m.signals_from<can_table::k_correlations.size()>(can_table::k_correlations[0]);
  DecodedCovariance decoded;
  decoded.counter = static_cast<std::uint8_t>(unsigned_of(frame.bytes(), m.signal("Counter")));
  decoded.state = static_cast<TrackState>(unsigned_of(frame.bytes(), m.signal("State")) & 3U);
  decoded.known = decoded.state == TrackState::measured || decoded.state == TrackState::predicted;
  std::array<double, can_table::k_pose_axes> sigma{};
  for (std::size_t i = 0; i < sigmas.size() && decoded.known; ++i) {
    const double value = value_or_unknown(unsigned_of(frame.bytes(), sigmas[i]), sigmas[i]);
    sigma[i] = value;
    decoded.known = value >= 0;
  }
  if (!decoded.known) return {decoded, Reason::none};
  std::size_t at = 0;
  for (std::size_t i = 0; i < sigma.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    decoded.covariance(row, row) = sigma[i] * sigma[i];
    for (std::size_t j = i + 1; j < sigma.size(); ++j, ++at) {
      const auto column = static_cast<Eigen::Index>(j);
      const auto raw = static_cast<double>(signed_of(frame.bytes(), correlations[at]));
      decoded.covariance(row, column) = decoded.covariance(column, row) =
          raw * correlations[at].step * sigma[i] * sigma[j];
    }
  }
  return {decoded, Reason::none};
}

}  // namespace glint
