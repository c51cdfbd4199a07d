// Settings and samples shared by the DDS tests.
#pragma once

#include "kernels/wire/pose_sample.hpp"
#include "platform/sinks/dds/dds_settings.hpp"

namespace glint {

// Unix time at which the companion computer's clock started.
inline constexpr Duration k_clock_start{1'700'000'000'000'000'000};
inline constexpr Duration k_period = milliseconds(4);

inline DdsSettings test_settings() {
  DdsSettings settings;
  settings.tick_period = k_period;
  settings.unix_minus_session = k_clock_start;
  settings.button_timeout = milliseconds(3'600'000);  // effectively no timeout
  return settings;
}

// Tick `number` of a tool; the pose differs between ticks.
inline PoseSample sample_at(std::uint32_t number, std::uint8_t tool = 0) {
  PoseSample sample;
  sample.tick = Time{} + k_period * number;
  sample.measurement = sample.tick - milliseconds(11);
  sample.tick_number = number;
  sample.frame_sequence = number / 5 + 1;
  sample.tool = tool;
  sample.marker_mask = 0b1011;
  sample.state = TrackState::measured;
  sample.reason = Reason::none;
  sample.registration = RegistrationState::given;
  sample.frame = ReferenceFrame::robot;
  sample.pose.translation = Vector3(0.1, -0.2, 0.3 + 0.001 * number);
  sample.pose.rotation = Quaternion(0.5, -0.5, 0.5, 0.5);
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column < 6; ++column) sample.covariance(row, column) = 10 * row + column;
  }
  return sample;
}

inline PoseSample lost_sample_at(std::uint32_t number) {
  PoseSample sample = sample_at(number);
  sample.state = TrackState::lost;
  sample.reason = Reason::too_old;
  sample.pose = Pose{};
  sample.covariance.setZero();
  return sample;
}

}  // namespace glint
