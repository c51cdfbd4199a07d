// Contents of a file named by a cell: of `glint calibrate`, or a robot description.
#pragma once

#include <string>

namespace glint {

inline constexpr const char* k_urdf_key = "robot.urdf";

// Keys of a cell that may name a file.
inline constexpr const char* k_named_keys[] = {"camera.file",        "camera.depth_bias",
                                               "camera.uncertainty", "motion.file",
                                               "correction.file",    k_urdf_key};

struct NamedFile {
  std::string key;   // one of these; key of the text in a recording
  std::string path;  // for messages
  std::string text;
};

}  // namespace glint
