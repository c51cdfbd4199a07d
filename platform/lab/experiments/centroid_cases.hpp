// Rendered spheres of the experiment `centroid`, and the bars of each case.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kernels/image/pixel_noise.hpp"
#include "platform/lab/experiments/sphere_images.hpp"

namespace glint {

struct CentroidCase {
  std::string name;
  SphereSetting setting;
  PixelNoise stated;       // for the stated variances: the setting's noise
  double rms_max_px = 0;   // 0: no bar
  bool whole = true;       // isolated: sigma has both bars; if cut or merged, only one
  std::uint8_t flag = 0;   // BlobFlag that the blob must have
  double diameter_px = 0;  // for the plot
};

// Diameters from 4 to 10 px: plain, motion-blurred, saturated and with low signal.
[[nodiscard]] std::vector<CentroidCase> sized_cases();

// Cut by the frame, with a neighbour, merged with it; 1.2 and 10 times saturated.
[[nodiscard]] std::vector<CentroidCase> disturbed_cases();

// 45 degrees off the axis, near and far, with a pinhole and with the headset's lens.
[[nodiscard]] std::vector<CentroidCase> off_axis_cases();

}  // namespace glint
