// Contents of a `glint calibrate` file named by a cell.
#pragma once

#include <string>

namespace glint {

// Keys of a cell that may name a file.
inline constexpr const char* k_named_keys[] = {
    "camera.file", "camera.depth_bias", "camera.uncertainty", "motion.file", "correction.file"};

struct NamedFile {
  std::string key;   // one of these; key of the text in a recording
  std::string path;  // for messages
  std::string text;
};

}  // namespace glint
