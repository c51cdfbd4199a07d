// What Glint knows of one time-of-flight camera: lens, depth, brightness, timing.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "kernels/image/pixel_noise.hpp"
#include "kernels/pose/camera_model.hpp"
#include "kernels/pose/depth_settings.hpp"
#include "kernels/units.hpp"

namespace glint {

struct Camera {
  std::string name;
  CameraModel model;
  DepthSettings depth;
  int reflectivity_bits = 16;   // 8: Frame::reflectivity_8, 16: Frame::reflectivity_16
  std::uint16_t threshold = 0;  // a marker's pixels are brighter than this
  PixelNoise noise{};           // of reflectivity: no device's was ever published
  Duration period;              // nominal gap between frames
  Duration exposure;
  Duration transport;                               // end of exposure -> last byte in memory
  double range_min_m = 0.15, range_max_m = 1.0;     // where tools are expected
  std::shared_ptr<const std::vector<float>> table;  // owns model.table.rays, if any
};

// HoloLens 1 short-throw: 448 x 450, 30 Hz, 8-bit reflectivity, Brown lens, threshold 250 (the
// seed's).
[[nodiscard]] Camera hololens1_short_throw();

// HoloLens 2 AHAT: 512 x 512, 45 Hz, 16-bit, radial depth that wraps at 1.055 m, rational lens.
[[nodiscard]] Camera hololens2_ahat();

// The same camera with a device's own table of unit rays (.npy, float32, 262144 x 3 or h x w x 3).
// Throws InputError naming the file, the place and what was expected.
[[nodiscard]] Camera with_ray_table(Camera camera, const std::string& npy_path);

}  // namespace glint
