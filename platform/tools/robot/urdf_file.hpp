// URDF reader with validation: the joints form a tree without loops.
#pragma once

#include <urdf_model/model.h>
#include <urdf_world/types.h>

#include <string>
#include <vector>

namespace glint {

struct UrdfFile {
  urdf::ModelInterfaceSharedPtr model;
  std::vector<std::string> joints;  // in file order; the model sorts them by name
};

// Throws InputError for text that is no URDF, for too deep nesting, more than k_robot_joints_max
// joints, and joints that form no tree; `from` replaces the file name. Joint names are printable.
[[nodiscard]] UrdfFile read_urdf(const std::string& path);
[[nodiscard]] UrdfFile read_urdf_text(const std::string& text, const std::string& from);

}  // namespace glint
