// Reader of depth images in PNG, which requires OpenCV.
#pragma once

#include <string>

#include "platform/tools/mapping/depth_sequence.hpp"

namespace glint {

// One plane of 16 bits, millimetres. Throws InputError naming the file and what was expected.
[[nodiscard]] DepthFrame read_depth_png(const std::string& path);

// Reads a sequence of PNG and .npy images.
[[nodiscard]] DepthSequence load_depth_sequence(const std::string& folder);

}  // namespace glint
