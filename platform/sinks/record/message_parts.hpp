// Deserialisation of the parts that several recorded messages share.
#pragma once

#include <cstdint>

#include "kernels/geometry.hpp"
#include "kernels/units.hpp"
#include "platform/sinks/record/cdr.hpp"

namespace glint {

// Skips a std_msgs/Header, which is for other programs; Glint's own time fields follow it.
inline void skip_header(CdrReader& from) {
  (void)from.get<std::int32_t>();
  (void)from.get<std::uint32_t>();
  (void)from.get_text();
}

// builtin_interfaces/Time.
[[nodiscard]] inline Time stamp_of(CdrReader& from) {
  const std::int64_t seconds = from.get<std::int32_t>();
  return {seconds * 1'000'000'000 + from.get<std::uint32_t>()};
}

template <class Stamped>
void get_stamps(CdrReader& from, Stamped& frame) {
  frame.mid_exposure.nanoseconds = from.get<std::int64_t>();
  frame.arrival.nanoseconds = from.get<std::int64_t>();
  frame.sequence = from.get<std::uint32_t>();
}

[[nodiscard]] inline Vector3 get_vector(CdrReader& from) {
  Vector3 vector;
  for (int axis = 0; axis < 3; ++axis) vector[axis] = from.get<double>();
  return vector;
}

[[nodiscard]] inline Pose get_pose(CdrReader& from) {
  Pose pose;
  pose.translation = get_vector(from);
  for (int i = 0; i < 4; ++i) pose.rotation.coeffs()[i] = from.get<double>();  // x, y, z, w
  return pose;
}

}  // namespace glint
