#include "platform/formats/camera.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string_view>
#include <utility>

#include "platform/formats/npy.hpp"
#include "platform/input_error.hpp"
#include "platform/read_file.hpp"

namespace glint {

Camera hololens1_short_throw() {
  Camera camera;
  camera.name = "hololens1_short_throw";
  camera.model.lens = Lens::brown;
  camera.model.width = 448;
  camera.model.height = 450;
  // No calibration of this camera is published. Placeholder: focal length of its successor and a
  // mild barrel distortion. Use a device's own calibration wherever accuracy matters.
  camera.model.fx = camera.model.fy = 253.0;
  camera.model.cx = 224.0;
  camera.model.cy = 225.0;
  camera.model.distortion = {-0.09, 0.02, 0.0005, -0.0003, 0, 0, 0, 0};
  camera.model.field_tangent_max = 1.4;  // the frame's corners are at 1.26
  camera.depth.kind = DepthKind::radial;
  camera.depth.unit_m = 0.001;
  camera.depth.invalid_from = 4090;  // HoloLensForCV: from here on the depth is invalid
  camera.depth.wrap_range_m = 0;
  // 8 bits saturate far below the level that corrupts a pixel's depth; the sensor then writes no
  // depth.
  camera.depth.saturated_from = 0xFFFF;
  camera.reflectivity_bits = 8;
  camera.threshold = 250;  // Puljiz et al.
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
  // MIT; fitted to its 209,594 rays, residual 0.062 px rms per axis, at most 0.28 px. Units differ
  // by 5 px.
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
  // HoloLens2-IRTracking binarises at this value. A real office, seen by another time-of-flight
  // camera, is below: 99.99 % of its pixels under 1115, maximum 1286. Retro-reflective markers are
  // far above.
  camera.threshold = 1280;
  camera.period = Duration{22'222'222};
  camera.exposure = milliseconds(2);
  camera.transport = milliseconds(8);
  return camera;
}

namespace {

// Without lens and threshold: none is published that holds for another device.
Camera camera_without_lens(std::string name, int width, int height, DepthKind depth) {
  Camera camera;
  camera.name = std::move(name);
  camera.model.width = width;
  camera.model.height = height;
  camera.depth.kind = depth;
  camera.depth.invalid_from = 0xFFFF;
  camera.period = Duration{33'333'333};
  camera.exposure = milliseconds(2);
  camera.transport = milliseconds(8);
  camera.range_max_m = 2;
  return camera;
}

Camera hololens2_long_throw() {
  Camera camera = camera_without_lens("hololens2_long_throw", 320, 288, DepthKind::radial);
  camera.period = milliseconds(200);
  camera.depth.invalid_from = 0xFFFF;  // the recorders write 0
  return camera;
}

// Source: Microsoft, Azure Kinect DK hardware specifications: exposure 12.8 ms, operating range;
// wide unbinned: 20.3 ms and 15 frames/s.
Camera azure_kinect(std::string name, int width, int height, double from_m, double to_m) {
  Camera camera = camera_without_lens(std::move(name), width, height, DepthKind::z);
  camera.exposure = microseconds(12'800);
  camera.range_min_m = from_m;
  camera.range_max_m = to_m;
  return camera;
}

Camera azure_kinect_wfov() {
  Camera camera = azure_kinect("azure_kinect_wfov", 1024, 1024, 0.25, 2.21);
  camera.exposure = microseconds(20'300);
  camera.period = Duration{66'666'667};
  return camera;
}

// Short range: radial depth (ml_depth_camera.h), 0.2 to 0.9 m. The headset stores floats in metres;
// here depth has 16 bits in millimetres.
Camera magic_leap2() {
  Camera camera = camera_without_lens("magic_leap2", 544, 480, DepthKind::radial);
  camera.period = Duration{16'666'667};
  camera.range_min_m = 0.2;
  camera.range_max_m = 0.9;
  return camera;
}

std::vector<Camera> all_cameras() {
  return {hololens2_ahat(),
          hololens1_short_throw(),
          hololens2_long_throw(),
          azure_kinect("azure_kinect_wfov_binned", 512, 512, 0.25, 2.88),
          azure_kinect("azure_kinect_nfov_binned", 320, 288, 0.5, 5.46),
          azure_kinect_wfov(),
          azure_kinect("azure_kinect_nfov", 640, 576, 0.5, 3.86),
          magic_leap2(),
          camera_without_lens("generic", 0, 0, DepthKind::z)};
}

}  // namespace

std::optional<Camera> camera_named(std::string_view name) {
  for (Camera& camera : all_cameras()) {
    if (camera.name == name) return std::move(camera);
  }
  return std::nullopt;
}

std::string camera_names() {
  std::string names;
  for (const Camera& camera : all_cameras()) names += (names.empty() ? "" : ", ") + camera.name;
  return names;
}

bool has_lens(const Camera& camera) {
  return ray_search_of(camera.model.lens) == RaySearch::table || camera.model.fx > 0;
}

namespace {

constexpr std::size_t k_ray_table_bytes_max = 256 << 20;

std::size_t pixels_of(const CameraModel& model) {
  return static_cast<std::size_t>(model.width) * static_cast<std::size_t>(model.height);
}

std::vector<float> floats_of(std::string_view bytes) {
  std::vector<float> values(bytes.size() / sizeof(float));
  std::memcpy(values.data(), bytes.data(), values.size() * sizeof(float));
  return values;
}

// hl2ss: planes of x and y at z = 1, then the extrinsics and data of the undistorted image. Pixels
// that the lens does not map have non-finite values or zeros.
std::vector<float> rays_of_planes(const std::vector<float>& values, std::size_t pixels) {
  std::vector<float> rays(3 * pixels, 0.0f);
  for (std::size_t i = 0; i < pixels; ++i) {
    const double x = values[i], y = values[pixels + i];
    if (!std::isfinite(x) || !std::isfinite(y) || (x == 0 && y == 0)) continue;
    const double scale = 1 / std::sqrt(x * x + y * y + 1);
    rays[3 * i] = static_cast<float>(x * scale);
    rays[3 * i + 1] = static_cast<float>(y * scale);
    rays[3 * i + 2] = static_cast<float>(scale);
  }
  return rays;
}

std::vector<float> rays_of_npy(const std::string& path, const CameraModel& model,
                               const std::string& name) {
  NpyArray array = read_npy_float32(path);
  const std::size_t width = static_cast<std::size_t>(model.width);
  const std::size_t height = static_cast<std::size_t>(model.height);
  const std::vector<std::size_t> flat{width * height, 3}, grid{height, width, 3};
  if (array.shape == flat || array.shape == grid) return std::move(array.values);
  std::string found;
  for (const std::size_t n : array.shape) found += (found.empty() ? "" : " x ") + std::to_string(n);
  throw InputError(path + ":shape: " + found + "; expected " + std::to_string(flat[0]) +
                   " x 3 or " + std::to_string(height) + " x " + std::to_string(width) +
                   " x 3, one ray for each pixel of " + name);
}

// Selects the format by content (NumPy magic) or by size.
std::vector<float> rays_of_file(const std::string& path, const CameraModel& model,
                                const std::string& name) {
  const std::string bytes = read_file(path, k_ray_table_bytes_max, "a table of rays");
  if (bytes.starts_with("\x93NUMPY")) return rays_of_npy(path, model, name);
  const std::size_t pixels = pixels_of(model);
  if (bytes.size() == 3 * pixels * sizeof(float)) return floats_of(bytes);
  if (hl2ss_calibration_bytes(model, true) == bytes.size() ||
      hl2ss_calibration_bytes(model, false) == bytes.size()) {
    return rays_of_planes(floats_of(bytes), pixels);
  }
  throw InputError(
      path + ": " + std::to_string(bytes.size()) + " bytes; expected a .npy file, " +
      std::to_string(3 * pixels * sizeof(float)) +
      " bytes of unit rays (StreamRecorder's _lut.bin), or hl2ss's calibration, each for the " +
      std::to_string(pixels) + " pixels of " + name);
}

// Initial guess for the search in a ray table: pinhole at the ray nearest to the optical axis.
void set_nearest_pinhole(CameraModel& model, const std::vector<float>& rays) {
  std::size_t middle = 0;
  for (std::size_t i = 0; i < pixels_of(model); ++i) {
    if (rays[3 * i + 2] > rays[3 * middle + 2]) middle = i;
  }
  const auto width = static_cast<std::size_t>(model.width);
  const std::size_t x = middle % width, y = middle / width;
  const std::size_t from = y * width + std::min(x, width - 2);
  const float* ray = rays.data() + 3 * from;
  const double step = ray[3] / ray[5] - ray[0] / ray[2];
  model.fx = model.fy = step > 0 ? 1 / step : 1.0;
  model.cx = static_cast<double>(x) + 0.5;
  model.cy = static_cast<double>(y) + 0.5;
}

}  // namespace

std::size_t hl2ss_calibration_bytes(const CameraModel& model, bool alias) {
  return (4 * pixels_of(model) + k_hl2ss_extrinsics + 1 + (alias ? 1 : 0) + 4) * sizeof(float);
}

std::vector<float> rays_of_hl2ss_calibration(std::span<const std::uint8_t> bytes,
                                             const CameraModel& model) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  return rays_of_planes(floats_of(text), pixels_of(model));
}

Camera with_ray_table(Camera camera, const std::string& path) {
  return with_rays(std::move(camera), rays_of_file(path, camera.model, camera.name), path);
}

Camera with_rays(Camera camera, std::vector<float> rays, const std::string& path) {
  const std::size_t pixels = pixels_of(camera.model);
  std::size_t valid = 0;
  for (std::size_t i = 0; i < pixels; ++i) {
    float* ray = rays.data() + 3 * i;
    const float square = ray[0] * ray[0] + ray[1] * ray[1] + ray[2] * ray[2];
    if (square == 0 || ray[2] == 0) {  // the lens maps nothing here
      ray[0] = ray[1] = ray[2] = 0;
      continue;
    }
    if (!(std::abs(square - 1) < 1e-3f) || !(ray[2] > 0)) {
      throw InputError(path + ":row " + std::to_string(i) +
                       ": not a unit vector with z above 0; expected unit rays, or zeros where the "
                       "lens maps nothing");
    }
    ++valid;
  }
  if (valid == 0) throw InputError(path + ": every ray is zero; expected unit rays");
  if (camera.model.fx == 0) set_nearest_pinhole(camera.model, rays);
  camera.table = std::make_shared<const std::vector<float>>(std::move(rays));
  camera.model.lens = Lens::lut;
  camera.model.table = {camera.model.width, camera.model.height, camera.table->data()};
  return camera;
}

}  // namespace glint
