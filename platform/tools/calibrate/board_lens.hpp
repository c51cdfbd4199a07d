// Lens parameters from corners of a calibration target, by OpenCV, with standard deviations.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "kernels/pose/camera_model.hpp"

namespace glint {

// For each image: detected corners, and their positions on the target, m.
struct TargetCorners {
  std::vector<std::vector<cv::Point2f>> corners;
  std::vector<std::vector<cv::Point3f>> target_points_m;
};

struct TargetLens {
  CameraModel model;           // field_tangent_max 0: no limit
  cv::Mat matrix, distortion;  // the same in OpenCV's form
  std::vector<cv::Mat> rotations, translations;
};

[[nodiscard]] TargetLens solve_lens(const TargetCorners& seen, const cv::Size& size, Lens lens);

// Standard deviations of a common rotation of all rays (pixels per axis) and of a common scale of
// all rays (ratio).
struct LensSigmas {
  double principal_point_px = 0, focal = 0;
};

// Jackknife over 3 x 3 parts of the image, each left out in turn. The model error of a lens is
// correlated between nearby pixels, not between images. Source: Efron 1982, chapter 3.
[[nodiscard]] LensSigmas lens_sigmas(const TargetCorners& seen, const cv::Size& size,
                                     const TargetLens& all);

}  // namespace glint
