// Pictures from files, by OpenCV.
#pragma once

#include <opencv2/core.hpp>
#include <string>

namespace glint {

// `flags` as cv::imread has them. Throws InputError naming the file: not there, no picture, or a
// PNG that says it is larger than 16,384 pixels a side or 64 million in all: OpenCV would take
// memory for them before it reads the first.
[[nodiscard]] cv::Mat read_picture(const std::string& path, int flags, const std::string& expected);

}  // namespace glint
