// A rational lens for a device's own table of rays.
#pragma once

#include <string>
#include <vector>

#include "kernels/pose/camera_model.hpp"

namespace glint {

struct LensFit {
  CameraModel model;
  double rms_px = 0;   // an axis, over every pixel that has a ray
  double most_px = 0;  // of |error|
  int pixels = 0;
  std::vector<double> error_by_angle_px;  // rms of |error|, a degree off the axis each
};

// The table: height x width x 3 or flat, width 0: as square as it is. Throws InputError naming the
// file for another shape or rays that are not of length 1, and for too few of them.
[[nodiscard]] LensFit fit_lens_to_table(const std::string& npy_path, int width);

}  // namespace glint
