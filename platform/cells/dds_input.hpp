// Choices of a cell's [dds]: the inputs that it allows by name, the node in ROS 2's graph.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace glint {

// The release of ROS 2 that reads ros_discovery_info: Humble's identifiers are longer.
enum class RosGraph : std::uint8_t { off, humble, iron };

enum class DdsInput : std::uint8_t {
  joint_states = 0,
  robot_description = 1,
  initial_pose = 2,
  buttons = 3,
  tools = 4,
};
inline constexpr std::size_t k_dds_inputs = 5;
inline constexpr std::array<const char*, k_dds_inputs> k_dds_input_names{
    "joint_states", "robot_description", "initial_pose", "buttons", "tools"};

[[nodiscard]] constexpr std::size_t index_of(DdsInput input) noexcept {
  return static_cast<std::size_t>(input);
}

struct AllowedInputs {
  std::array<bool, k_dds_inputs> by_input{};

  [[nodiscard]] bool operator[](DdsInput input) const noexcept { return by_input[index_of(input)]; }
  void add(DdsInput input) noexcept { by_input[index_of(input)] = true; }
};

}  // namespace glint
