// CAN decoding of a pose: the inverse of can_frames.hpp, for `inspect` and tests.
//
// What:     one protected frame -> values in SI.
// Cost:     a CRC over the frame and a few shifts; one square root for a rotation.
// Worst:    data independent.
// Accuracy: exact: integer x step.
// Source:   the layout in can_messages.hpp.
#pragma once

#include <cstdint>

#include "kernels/result.hpp"
#include "kernels/wire/can_frame.hpp"
#include "kernels/wire/pose_sample.hpp"

namespace glint {

// Each decoder returns Reason::frame_invalid for a wrong length or kind of frame or a failed check.
// The data identifier of the check is the frame's own CAN identifier.
struct DecodedPosition {
  std::uint8_t counter = 0;
  bool valid = false;
  Vector3 position_m = Vector3::Zero();
};
[[nodiscard]] Result<DecodedPosition> decode_position(const CanFrame& frame) noexcept;

struct DecodedOrientation {
  std::uint8_t counter = 0;
  TrackState state = TrackState::none;
  Quaternion rotation = Quaternion::Identity();
};
[[nodiscard]] Result<DecodedOrientation> decode_orientation(const CanFrame& frame) noexcept;

struct DecodedVelocity {
  std::uint8_t counter = 0;
  TrackState state = TrackState::none;
  Vector3 velocity = Vector3::Zero();  // m/s or rad/s
};
[[nodiscard]] Result<DecodedVelocity> decode_velocity(const CanFrame& frame) noexcept;
[[nodiscard]] Result<DecodedVelocity> decode_angular_velocity(const CanFrame& frame) noexcept;

// A negative value means "too large for its field, or unknown".
struct DecodedQuality {
  std::uint8_t counter = 0;
  TrackState state = TrackState::none;
  RegistrationState registration = RegistrationState::none;
  std::uint8_t markers = 0;
  std::uint8_t buttons = 0;
  double sigma_position_m = -1;
  double sigma_orientation_rad = -1;
  double age_s = -1;
  double registration_rms_m = -1;
};
[[nodiscard]] Result<DecodedQuality> decode_quality(const CanFrame& frame) noexcept;

struct DecodedFdPose {
  DecodedQuality quality;
  Vector3 position_m = Vector3::Zero();
  Quaternion rotation = Quaternion::Identity();
  Vector3 velocity_m_s = Vector3::Zero();
  Vector3 angular_velocity_rad_s = Vector3::Zero();
  std::int64_t unix_measurement_ns = 0;
  std::uint32_t frame_sequence = 0;
};
[[nodiscard]] Result<DecodedFdPose> decode_fd_pose(const CanFrame& frame) noexcept;

struct DecodedCovariance {
  std::uint8_t counter = 0;
  TrackState state = TrackState::none;
  Matrix6 covariance = Matrix6::Zero();  // of x, y, z [m] and rotation [rad]
  bool known = false;                    // false: no pose, or a deviation beyond its field
};
[[nodiscard]] Result<DecodedCovariance> decode_covariance(const CanFrame& frame) noexcept;

}  // namespace glint
