// A URDF file, read and checked: after it nothing can run in a circle.
#pragma once

#include <urdf_model/model.h>
#include <urdf_world/types.h>

#include <string>
#include <vector>

namespace glint {

struct UrdfFile {
  urdf::ModelInterfaceSharedPtr model;
  std::vector<std::string> joints;  // in the order of the file; the model sorts them by name
};

// Throw InputError for what is no URDF, nested too deep, with more than k_robot_joints_max joints,
// or joints that form no tree; `from` is named in place of a file. Joints' names are printable.
[[nodiscard]] UrdfFile read_urdf(const std::string& path);
[[nodiscard]] UrdfFile read_urdf_text(const std::string& text, const std::string& from);

}  // namespace glint
