// Fit of a rational lens model to a device's ray table.
#pragma once

#include <string>
#include <vector>

#include "kernels/pose/camera_model.hpp"

namespace glint {

struct LensFit {
  CameraModel model;
  double rms_px = 0;        // per axis, over all pixels with a ray
  double error_max_px = 0;  // largest |error|
  int pixels = 0;
  std::vector<double> error_by_angle_px;  // rms of |error| in each degree off the axis
};

// Table shape: height x width x 3, or flat; width 0 assumes a square image. Throws InputError
// naming the file for another shape, for rays that are not of length 1, and for too few rays.
[[nodiscard]] LensFit fit_lens_to_table(const std::string& npy_path, int width);

}  // namespace glint
