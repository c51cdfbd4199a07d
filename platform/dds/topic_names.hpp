// Topic and frame names, made from a tool's name.
//
// ROS 2 puts "rt" before a topic's name and allows letters, digits and underscores, no digit first
// (rmw_cyclonedds, namespace_prefix.hpp; ROS 2 design article "Topic and Service name mapping").
#pragma once

#include <string>
#include <string_view>

namespace glint {

// Any other character becomes '_'; "tool_" goes in front of a leading digit or an empty name.
[[nodiscard]] std::string ros_name(std::string_view text);

struct ToolTopics {
  std::string status;           // rt/PREFIX/TOOL_status
  std::string pose;             // rt/PREFIX/TOOL_pose
  std::string pose_covariance;  // rt/PREFIX/TOOL_pose_covariance: the total
  std::string pose_systematic;  // rt/PREFIX/TOOL_pose_systematic: its systematic part
  std::string tip_frame;        // PREFIX_TOOL_tip
};
[[nodiscard]] ToolTopics topics_of(std::string_view prefix, std::string_view tool);

inline constexpr const char* k_tf_topic = "rt/tf";
inline constexpr const char* k_tf_static_topic = "rt/tf_static";
inline constexpr const char* k_diagnostics_topic = "rt/diagnostics";

// A ROS topic's name in DDS: "/ir/image" is "rt/ir/image". Empty: no name of a topic.
[[nodiscard]] std::string dds_topic(std::string_view ros_topic);

// Under a prefix as tools' topics are: rt/PREFIX/NAME.
[[nodiscard]] std::string topic_under(std::string_view prefix, std::string_view name);
inline constexpr const char* k_map_points_name = "map_points";
inline constexpr const char* k_octomap_name = "octomap";
inline constexpr const char* k_path_name = "path";

inline constexpr const char* k_tool_add_name = "tool_add";
inline constexpr const char* k_tool_remove_name = "tool_remove";

inline constexpr const char* k_joint_states_topic = "rt/joint_states";
inline constexpr const char* k_robot_description_topic = "rt/robot_description";
inline constexpr const char* k_initial_pose_topic = "rt/initialpose";

}  // namespace glint
