// ROS 2's transforms and poses by their messages' bytes: tf2_msgs/TFMessage, PoseStamped.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "platform/sources/transform_tree.hpp"

namespace glint {

// What is not whole ends a message; the transforms before it hold. `fixed`: of tf_static.
void add_ros_transforms(std::span<const std::uint8_t> message, bool fixed, TransformTree& to);

// The pose of `child` in the message's frame, which it returns; empty: a message that is not whole.
std::string_view add_ros_pose(std::span<const std::uint8_t> message, std::string_view child,
                              TransformTree& to);

}  // namespace glint
