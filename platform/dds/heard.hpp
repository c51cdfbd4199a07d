// What others say of the robot and the pen, checked and of a bounded size.
//
// A message that is not whole, not finite or too large is refused, never cut: half a joint state is
// no joint state.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "kernels/geometry.hpp"
#include "kernels/units.hpp"
#include "platform/dds/messages.hpp"
#include "platform/dds/topic_types.hpp"

namespace glint {

inline constexpr int k_heard_joints_max = 64;
inline constexpr std::size_t k_heard_name_max = 63;  // characters of a joint's or a frame's name
inline constexpr std::size_t k_heard_description_max = std::size_t{4} << 20;

using HeardName = std::array<char, k_heard_name_max + 1>;  // ends in 0

struct HeardJoints {
  Time time;  // on the board's clock: the message's stamp, or its arrival where it has none
  int count = 0;
  std::array<HeardName, k_heard_joints_max> names{};
  std::array<double, k_heard_joints_max> positions{};  // rad or m, as their joints are
};

// RViz's guess of where the robot stands.
struct HeardGuess {
  Time time;
  HeardName frame{};
  Pose pose;                             // T_frame_robot
  Matrix6 covariance = Matrix6::Zero();  // x, y, z, rotation about fixed axes x, y, z
};

struct HeardDescription {
  std::string urdf;
};

// From a message that arrived at `arrival` (board). False: refused, and `to` may hold anything.
[[nodiscard]] bool hear(const JointStateMessage& message, Duration unix_minus_board, Time arrival,
                        HeardJoints& to);
[[nodiscard]] bool hear(const PoseCovarianceMessage& message, Duration unix_minus_board,
                        Time arrival, HeardGuess& to);
[[nodiscard]] bool hear(const TextMessage& message, HeardDescription& to);

// The positions of these joints, by their names; others are passed over. How many were found before
// one that is not there once: all of them, or the number of the one that is wrong.
[[nodiscard]] std::size_t positions_of(const HeardJoints& joints,
                                       std::span<const std::string> names,
                                       std::span<double> positions) noexcept;

}  // namespace glint
