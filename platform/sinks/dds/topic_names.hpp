// DDS topic names and frame names from a tool's name.
//
// ROS 2 prefixes topic names with "rt" and allows letters, digits and underscores, no digit first
// (rmw_cyclonedds, namespace_prefix.hpp; ROS 2 design article "Topic and Service name mapping").
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "platform/cells/dds_input.hpp"

namespace glint {

// Replaces any other character by '_'; prefixes "tool_" to a leading digit or an empty name.
[[nodiscard]] std::string ros_name(std::string_view text);

struct ToolTopics {
  std::string status;           // rt/PREFIX/TOOL_status
  std::string pose;             // rt/PREFIX/TOOL_pose
  std::string pose_covariance;  // rt/PREFIX/TOOL_pose_covariance: the total
  std::string pose_systematic;  // rt/PREFIX/TOOL_pose_systematic: its systematic part
  std::string tip_frame;        // PREFIX_TOOL_tip
};
// `space`: the namespace of a named run; empty: none. The frame's name is without it.
[[nodiscard]] ToolTopics topics_of(std::string_view prefix, std::string_view tool,
                                   std::string_view space = "");

inline constexpr const char* k_tf_topic = "rt/tf";
inline constexpr const char* k_tf_static_topic = "rt/tf_static";
inline constexpr const char* k_diagnostics_topic = "rt/diagnostics";

// DDS topic of a named run: "rt/tf" becomes "rt/SPACE/tf"; unchanged without a space.
[[nodiscard]] std::string topic_in(std::string_view space, std::string_view topic);

// DDS name of a ROS topic: "/ir/image" becomes "rt/ir/image". Empty if the name is invalid.
[[nodiscard]] std::string dds_topic(std::string_view ros_topic);

// Topic under a prefix: rt/PREFIX/NAME.
[[nodiscard]] std::string topic_under(std::string_view prefix, std::string_view name);
inline constexpr const char* k_map_points_name = "map_points";
inline constexpr const char* k_octomap_name = "octomap";
inline constexpr const char* k_path_name = "path";

inline constexpr const char* k_joint_states_topic = "rt/joint_states";
inline constexpr const char* k_robot_description_topic = "rt/robot_description";
inline constexpr const char* k_initial_pose_topic = "rt/initialpose";

// Topics of an input: buttons in the order of Button, tools that are added and removed.
[[nodiscard]] std::vector<std::string> topics_of(DdsInput input, std::string_view prefix,
                                                 std::string_view space);

}  // namespace glint
