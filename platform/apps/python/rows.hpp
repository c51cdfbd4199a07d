// Rows of the module's numpy arrays: plain structures, whose fields README.md describes.
//
// Units are in the names. Rotations are quaternions x y z w. Without a pose its numbers are NaN.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "kernels/geometry.hpp"

namespace glint::python {

inline constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();

struct FramePoseRow {
  std::int64_t time_ns;
  std::uint64_t sequence;
  std::uint8_t tool, state, reason, frame, marker_mask;
  double rms_m;
  double position_m[3], orientation_xyzw[4];
  double covariance[6][6];
};

struct TickPoseRow {
  std::int64_t time_ns, measurement_ns;
  std::uint32_t tick, sequence;
  std::uint8_t tool, state, reason, registration, frame, marker_mask, buttons;
  double position_m[3], orientation_xyzw[4];
  double velocity_m_s[3], angular_velocity_rad_s[3];
  double covariance[6][6], systematic[6][6];
  double sigma_position_m, sigma_orientation_rad, registration_rms_m;
};

struct BlobRow {
  std::int64_t time_ns;
  std::uint64_t sequence;
  double ray[3], surface_range_m, centroid_px[2];
  double sigma_px[2], range_sigma_m, bias_subtracted_m;
  std::uint32_t area_px;
  std::uint16_t peak;
  std::uint8_t flags;
};

struct HeadPoseRow {
  std::int64_t time_ns;
  bool valid;
  double position_m[3], orientation_xyzw[4];
};

struct ButtonRow {
  std::int64_t time_ns;
  std::uint8_t button;
  bool pressed;
};

struct HeldButtonsRow {
  std::int64_t time_ns;
  std::uint64_t version;
  std::uint8_t held;
};

struct RobotFrameRow {
  std::int64_t time_ns;
  std::uint64_t version;
  std::uint8_t state;
  bool in_reference;
  double rms_m;
  double position_m[3], orientation_xyzw[4];
};

struct ChoiceRow {
  std::int64_t time_ns;
  std::int64_t unix_offset_ns;
  std::uint64_t activation;
  std::uint64_t versions[4];
  std::uint8_t group, version_count, overrun, policy, after_node;
};

struct DroppedRow {
  std::int64_t time_ns, arrival_ns;
  std::uint64_t sequence;
  std::uint8_t reason;
};

struct CanPoseRow {
  std::int64_t unix_ns, tick, lost;
  std::uint8_t tool, counter, state, registration, markers, buttons;
  bool valid, complete, checksum_ok;
  double position_m[3], orientation_xyzw[4];
  double velocity_m_s[3], angular_velocity_rad_s[3];
  double sigma_position_m, sigma_orientation_rad, age_s, registration_rms_m;
};

template <std::size_t count>
void put(double (&to)[count], const auto& vector) {
  for (std::size_t i = 0; i < count; ++i) to[i] = vector[static_cast<Eigen::Index>(i)];
}
inline void put(double (&to)[4], const Quaternion& rotation) { put(to, rotation.coeffs()); }
inline void put(double (&to)[6][6], const Matrix6& matrix) {
  for (Eigen::Index row = 0; row < 6; ++row)
    for (Eigen::Index column = 0; column < 6; ++column) to[row][column] = matrix(row, column);
}
template <std::size_t count>
void put_nothing(double (&to)[count]) {
  std::fill_n(to, count, k_nan);
}
inline void put_nothing(double (&to)[6][6]) {
  for (auto& row : to) put_nothing(row);
}

}  // namespace glint::python
