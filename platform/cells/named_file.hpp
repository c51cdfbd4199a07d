// A file of `glint calibrate` that a cell names, as it was read.
#pragma once

#include <string>

namespace glint {

// Where a cell may name one.
inline constexpr const char* k_named_keys[] = {
    "camera.file", "camera.depth_bias", "camera.uncertainty", "motion.file", "correction.file"};

struct NamedFile {
  std::string key;   // one of these; a recording carries the text under it
  std::string path;  // for messages
  std::string text;
};

}  // namespace glint
