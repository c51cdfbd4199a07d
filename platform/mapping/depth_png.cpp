#include "platform/mapping/depth_png.hpp"

#include <opencv2/imgcodecs.hpp>

#include "platform/input_error.hpp"
#include "platform/sensors/read_picture.hpp"

namespace glint {

DepthFrame read_depth_png(const std::string& path) {
  const cv::Mat image = read_picture(path, cv::IMREAD_UNCHANGED, "a PNG with one plane of 16 bits");
  if (image.type() != CV_16UC1) {
    throw InputError(path + ": is no PNG with one plane of 16 bits; expected depth in millimetres");
  }
  if (image.cols > k_depth_side_max || image.rows > k_depth_side_max) {
    throw InputError(path + ": " + std::to_string(image.cols) + " x " + std::to_string(image.rows) +
                     " pixels; expected 1 to " + std::to_string(k_depth_side_max) + " a side");
  }
  DepthFrame out{image.cols, image.rows, {}, {}, {}};
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      out.depth_m.push_back(1e-3f * static_cast<float>(image.at<std::uint16_t>(y, x)));
    }
  }
  return out;
}

DepthSequence load_depth_sequence(const std::string& folder) {
  return read_depth_sequence(folder, read_depth_png);
}

}  // namespace glint
