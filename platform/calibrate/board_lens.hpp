// A lens from the corners of boards, by OpenCV, and its standard deviations.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "kernels/pose/camera_model.hpp"

namespace glint {

// Of each picture: corners, and where they are on the board, m.
struct BoardCorners {
  std::vector<std::vector<cv::Point2f>> corners;
  std::vector<std::vector<cv::Point3f>> boards;
};

struct BoardLens {
  CameraModel model;           // field_tangent_max 0: no limit
  cv::Mat matrix, distortion;  // the same as OpenCV has it
  std::vector<cv::Mat> rotations, translations;
};

[[nodiscard]] BoardLens solve_lens(const BoardCorners& seen, const cv::Size& size, Lens lens);

// Standard deviations of what rays all turn by, pixels an axis, and of what they all are wider by,
// a ratio.
struct LensSigmas {
  double principal_point_px = 0, focal = 0;
};

// Each time one of 3 x 3 parts of the picture is left out: what the lens has and its model has not
// is alike nearby, not from picture to picture. Source: the jackknife, Efron 1982, chapter 3.
[[nodiscard]] LensSigmas lens_sigmas(const BoardCorners& seen, const cv::Size& size,
                                     const BoardLens& all);

}  // namespace glint
