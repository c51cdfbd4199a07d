// Pose samples for the tests of the wire formats.
#pragma once

#include <random>

#include "kernels/wire/pose_sample.hpp"

namespace glint {

// Returns a random sample; every field is inside the range of every format.
inline PoseSample random_sample(std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto vector = [&](double size) {
    const double x = unit(random), y = unit(random), z = unit(random);
    return Vector3(size * x, size * y, size * z);
  };
  PoseSample s;
  s.tick_number = static_cast<std::uint32_t>(random());
  s.frame_sequence = static_cast<std::uint32_t>(random());
  s.measurement = {static_cast<std::int64_t>(random()) * 1000};
  s.tick = s.measurement + microseconds(static_cast<std::int64_t>(random() % 400000));
  s.tool = static_cast<std::uint8_t>(random() % k_tools_max);
  s.marker_mask = static_cast<std::uint8_t>(random());
  s.buttons = static_cast<std::uint8_t>(random() % 8);
  s.state = random() % 2 == 0 ? TrackState::measured : TrackState::predicted;
  s.registration = static_cast<RegistrationState>(random() % 4);
  s.frame = static_cast<ReferenceFrame>(random() % 3);
  s.reason = Reason::none;
  s.pose.translation = vector(3.27);
  s.pose.rotation = Quaternion(unit(random), unit(random), unit(random), 0.1).normalized();
  s.velocity_m_s = vector(3.27);
  s.angular_velocity_rad_s = vector(32.7);
  for (int i = 0; i < 36; ++i) s.covariance(i / 6, i % 6) = 1e-6 * unit(random);
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column <= row; ++column)
      s.systematic(row, column) = s.systematic(column, row) = 1e-6 * unit(random);
  }
  s.sigma_position_m = 5e-3 * (1 + unit(random));
  s.sigma_orientation_rad = 0.08 * (1 + unit(random));
  s.registration_rms_m = 6e-3 * (1 + unit(random));
  return s;
}

}  // namespace glint
