// The texts that tell other programs how to read our messages.
#pragma once

#include <string>
#include <string_view>

namespace glint {

// The ros2msg text of "geometry_msgs/msg/PoseStamped" or any other type that a recording holds:
// its own fields, then those of every type in it. A name that is not in the list ends the program.
[[nodiscard]] std::string schema_text(std::string_view name);

}  // namespace glint
