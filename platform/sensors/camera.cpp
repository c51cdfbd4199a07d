#include "platform/sensors/camera.hpp"

#include <cmath>

#include "platform/input_error.hpp"
#include "platform/sensors/npy.hpp"

namespace glint {

Camera hololens1_short_throw() {
  Camera camera;
  camera.name = "hololens1_short_throw";
  camera.model.lens = Lens::brown;
  camera.model.width = 448;
  camera.model.height = 450;
  // No calibration of this camera was ever published: a focal length like its successor's and a
  // mild barrel distortion stand in. Use a device's own wherever a number matters.
  camera.model.fx = camera.model.fy = 253.0;
  camera.model.cx = 224.0;
  camera.model.cy = 225.0;
  camera.model.distortion = {-0.09, 0.02, 0.0005, -0.0003, 0, 0, 0, 0};
  camera.model.field_tangent_max = 1.4;  // the frame's corners lie at 1.26
  camera.depth.kind = DepthKind::radial;
  camera.depth.unit_m = 0.001;
  camera.depth.invalid_from = 4090;  // HoloLensForCV: from here on the depth is invalid
  camera.depth.wrap_range_m = 0;
  // Eight bits clip far below what spoils a pixel's depth; the sensor itself then writes none.
  camera.depth.saturated_from = 0xFFFF;
  camera.reflectivity_bits = 8;
  camera.threshold = 250;  // the seed's
  camera.period = Duration{33'333'333};
  camera.exposure = milliseconds(2);
  camera.transport = milliseconds(8);
  return camera;
}

Camera hololens2_ahat() {
  Camera camera;
  camera.name = "hololens2_ahat";
  camera.model.lens = Lens::rational;
  camera.model.width = 512;
  camera.model.height = 512;
  // Calibration of a HoloLens 2 published by lihaowei1999/IRToolTrackingWithHololens2 (1a3905e),
  // MIT; fitted over its 209,594 rays, 0.062 px rms an axis, 0.28 px at most. Units differ by 5 px.
  camera.model.fx = 253.247009763;
  camera.model.fy = 253.582053183;
  camera.model.cx = 258.754402348;
  camera.model.cy = 254.752807282;
  camera.model.distortion = {0.483160358562,  0.192690496386, 0.000807326604142, -9.40674893651e-05,
                             0.0138065295212, 0.815416536943, 0.289178608617,    0.0623515734461};
  camera.model.field_tangent_max = 1.7363;  // its widest ray: 60 degrees off the axis
  camera.depth.kind = DepthKind::radial;
  camera.depth.unit_m = 0.001;
  camera.depth.invalid_from = 4090;   // HoloLens2ForCV: from here on the depth is invalid
  camera.depth.wrap_range_m = 1.055;  // hl2ss: "alias" 1055 of the device's calibration
  camera.depth.saturated_from = 0xFFFF;
  camera.reflectivity_bits = 16;
  // HoloLens2-IRTracking binarises here. A real office seen by another time-of-flight camera stays
  // below: 99.99 % of its pixels under 1115, the brightest 1286; retro-reflective markers far
  // above.
  camera.threshold = 1280;
  camera.period = Duration{22'222'222};
  camera.exposure = milliseconds(2);
  camera.transport = milliseconds(8);
  return camera;
}

Camera with_ray_table(Camera camera, const std::string& npy_path) {
  NpyArray array = read_npy_float32(npy_path);
  const std::size_t width = static_cast<std::size_t>(camera.model.width);
  const std::size_t height = static_cast<std::size_t>(camera.model.height);
  const std::vector<std::size_t> flat{width * height, 3}, grid{height, width, 3};
  if (array.shape != flat && array.shape != grid) {
    std::string found;
    for (const std::size_t n : array.shape)
      found += (found.empty() ? "" : " x ") + std::to_string(n);
    throw InputError(npy_path + ":shape: " + found + "; expected " + std::to_string(flat[0]) +
                     " x 3 or " + std::to_string(height) + " x " + std::to_string(width) +
                     " x 3, a ray for each pixel of " + camera.name);
  }
  std::size_t valid = 0;
  for (std::size_t i = 0; i < width * height; ++i) {
    float* ray = array.values.data() + 3 * i;
    const float square = ray[0] * ray[0] + ray[1] * ray[1] + ray[2] * ray[2];
    if (square == 0 || ray[2] == 0) {  // the lens maps nothing here
      ray[0] = ray[1] = ray[2] = 0;
      continue;
    }
    if (!(std::abs(square - 1) < 1e-3f) || !(ray[2] > 0)) {
      throw InputError(
          npy_path + ":row " + std::to_string(i) +
          ": not a unit vector ahead of the camera; expected unit rays, or zeros where "
          "the lens maps nothing");
    }
    ++valid;
  }
  if (valid == 0) throw InputError(npy_path + ": every ray is zero; expected unit rays");
  camera.table = std::make_shared<const std::vector<float>>(std::move(array.values));
  camera.model.lens = Lens::lut;
  camera.model.table = {camera.model.width, camera.model.height, camera.table->data()};
  return camera;
}

}  // namespace glint
