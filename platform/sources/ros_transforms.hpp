// Parser of ROS 2 messages with transforms and poses: tf2_msgs/TFMessage, PoseStamped.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "platform/sources/transform_tree.hpp"

namespace glint {

// Adds transforms up to the first incomplete one. fixed: from tf_static.
void add_ros_transforms(std::span<const std::uint8_t> message, bool fixed, TransformTree& to);

// Adds the pose of `child` in the message's frame and returns that frame; empty for an incomplete
// message.
std::string_view add_ros_pose(std::span<const std::uint8_t> message, std::string_view child,
                              TransformTree& to);

}  // namespace glint
