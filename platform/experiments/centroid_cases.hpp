// The spheres that the experiment `centroid` renders, and what is asked of each.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kernels/image/pixel_noise.hpp"
#include "platform/experiments/sphere_pictures.hpp"

namespace glint {

struct CentroidCase {
  std::string name;
  SphereSetting setting;
  PixelNoise stated;       // what the variances are computed with: the setting's noise
  double rms_max_px = 0;   // 0: no bar
  bool whole = true;       // its sigma holds both ways; of what is cut or merged it may be larger
  std::uint8_t flag = 0;   // BlobFlag that it must have
  double diameter_px = 0;  // for the plot
};

// Sizes from 4 to 10 px, as they come, smeared, saturated and weak.
[[nodiscard]] std::vector<CentroidCase> sized_cases();

// Cut by the frame, beside another, merged with it; hardly and ten times saturated.
[[nodiscard]] std::vector<CentroidCase> spoilt_cases();

// 45 degrees off the axis, near and far, by a pinhole and by the headset's own lens.
[[nodiscard]] std::vector<CentroidCase> off_axis_cases();

}  // namespace glint
