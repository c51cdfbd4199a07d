// ROS 2 message types for maps, paths, images and the robot's inputs.
#pragma once

#include <optional>
#include <string_view>

#include "nav_msgs.h"
#include "octomap_msgs.h"
#include "platform/sinks/dds/participant.hpp"
#include "sensor_msgs.h"

namespace glint {

using PointFieldMessage = sensor_msgs_msg_dds__PointField_;
using CloudMessage = sensor_msgs_msg_dds__PointCloud2_;
using JointStateMessage = sensor_msgs_msg_dds__JointState_;
using OctomapMessage = octomap_msgs_msg_dds__Octomap_;
using PathMessage = nav_msgs_msg_dds__Path_;
using TextMessage = std_msgs_msg_dds__String_;
using BoolMessage = std_msgs_msg_dds__Bool_;

[[nodiscard]] TopicType cloud_type();
[[nodiscard]] TopicType octomap_type();
[[nodiscard]] TopicType path_type();
[[nodiscard]] TopicType image_type();
[[nodiscard]] TopicType camera_info_type();
[[nodiscard]] TopicType joint_state_type();
[[nodiscard]] TopicType text_type();
[[nodiscard]] TopicType bool_type();

// Any type of a topic that a DdsProcess serves, by its DDS name; empty: none.
[[nodiscard]] std::optional<TopicType> type_named(std::string_view name);

}  // namespace glint
