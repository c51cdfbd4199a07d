// Validation and fixed-size storage of received messages about the robot and the pen.
//
// An incomplete, non-finite or oversized message is rejected, never truncated: a partial joint
// state is invalid.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "kernels/geometry.hpp"
#include "kernels/units.hpp"

namespace glint {

inline constexpr int k_received_joints_max = 64;
inline constexpr std::size_t k_received_name_max = 63;  // characters of a joint's or a frame's name
inline constexpr std::size_t k_received_description_max = std::size_t{4} << 20;

using BoundedName = std::array<char, k_received_name_max + 1>;  // zero-terminated

struct ReceivedJoints {
  Time time;  // session time: the message's time stamp, or its arrival if it has none
  int count = 0;
  std::array<BoundedName, k_received_joints_max> names{};
  std::array<double, k_received_joints_max> positions{};  // rad or m, by joint type
};

// Initial guess of the robot's pose, from RViz.
struct ReceivedInitialPose {
  Time time;
  BoundedName frame{};
  Pose pose;                             // T_frame_robot
  Matrix6 covariance = Matrix6::Zero();  // x, y, z, rotation about fixed axes x, y, z
};

struct ReceivedDescription {
  std::string urdf;
};

// Serialised messages: sensor_msgs/JointState, geometry_msgs/PoseWithCovarianceStamped,
// std_msgs/String and std_msgs/Bool. `arrival`: arrival in session time. Returns false for a
// rejected message; `to` is then unspecified.
using MessageBytes = std::span<const std::uint8_t>;
[[nodiscard]] bool read_message(MessageBytes message, Duration unix_minus_session, Time arrival,
                                ReceivedJoints& to);
[[nodiscard]] bool read_message(MessageBytes message, Duration unix_minus_session, Time arrival,
                                ReceivedInitialPose& to);
[[nodiscard]] bool read_message(MessageBytes message, ReceivedDescription& to);
[[nodiscard]] bool read_message(MessageBytes message, bool& to);
// The text of a std_msgs/String; empty if it is none.
[[nodiscard]] std::string_view text_of(MessageBytes message);

// Finds the positions of the named joints; ignores all others. Returns names.size(), or the index
// of the first name that does not occur exactly once.
[[nodiscard]] std::size_t positions_of(const ReceivedJoints& joints,
                                       std::span<const std::string> names,
                                       std::span<double> positions) noexcept;

}  // namespace glint
