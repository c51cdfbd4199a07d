// Message schemas (ros2msg) for other programs.
#pragma once

#include <string>
#include <string_view>

namespace glint {

// The ros2msg text of "geometry_msgs/msg/PoseStamped" or any other recorded type: its own fields,
// then those of every contained type. An unknown name ends the program.
[[nodiscard]] std::string schema_text(std::string_view name);

}  // namespace glint
