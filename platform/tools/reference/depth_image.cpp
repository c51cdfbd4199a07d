#include "platform/tools/reference/depth_image.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>

#include "platform/formats/image_file.hpp"
#include "platform/formats/npy.hpp"
#include "platform/input_error.hpp"
#include "platform/tools/mapping/cloud_files.hpp"

namespace glint {
namespace {

std::string kind_of(const std::string& path) {
  std::string kind = std::filesystem::path(path).extension().string();
  std::transform(kind.begin(), kind.end(), kind.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return kind;
}

void check_size(const std::string& path, std::size_t width, std::size_t height,
                const CameraModel& camera) {
  if (width == static_cast<std::size_t>(camera.width) &&
      height == static_cast<std::size_t>(camera.height)) {
    return;
  }
  throw InputError(path + ": " + std::to_string(width) + " x " + std::to_string(height) +
                   " pixels; expected the camera's " + std::to_string(camera.width) + " x " +
                   std::to_string(camera.height));
}

// Requires rows and columns; drops additional dimensions of length 1.
NpyNumbers npy_picture(const std::string& path, const CameraModel& camera) {
  NpyNumbers array = read_npy_numbers(path);
  if (array.shape.size() > 2) std::erase(array.shape, std::size_t{1});
  if (array.shape.size() != 2) {
    throw InputError(path + ": " + std::to_string(array.shape.size()) +
                     " dimensions; expected rows and columns");
  }
  check_size(path, array.shape[1], array.shape[0], camera);
  return array;
}

Image png_picture(const std::string& path, const CameraModel& camera) {
  Image picture = read_png(path, "a PNG image");
  check_size(path, static_cast<std::size_t>(picture.width),
             static_cast<std::size_t>(picture.height), camera);
  return picture;
}

float depth_of(double metres) {
  const auto z = static_cast<float>(metres);
  return z > 0 && z < k_depth_max_m ? z : 0;  // 0 for NaN
}

}  // namespace

DepthImage read_depth(const std::string& path, const CameraModel& camera) {
  const std::string kind = kind_of(path);
  DepthImage out{camera.width, camera.height, {}};
  if (kind == ".npy") {
    const NpyNumbers array = npy_picture(path, camera);
    const double scale = array.integer ? 1e-3 : 1;
    for (const double value : array.values) out.z_m.push_back(depth_of(value * scale));
  } else if (kind == ".png") {
    const Image picture = png_picture(path, camera);
    if (picture.channels != 1 || picture.bits != 16) {
      throw InputError(path + ": expected one channel of 16 bit, millimetres");
    }
    for (const std::uint16_t value : picture.values) out.z_m.push_back(depth_of(1e-3 * value));
  } else {
    throw InputError(path + ": expected depth as .npy, .png, .pcd or .ply");
  }
  if (std::all_of(out.z_m.begin(), out.z_m.end(), [](float z) { return z == 0; })) {
    throw InputError(path + ": no pixel has a depth between 0 and " +
                     std::to_string(static_cast<int>(k_depth_max_m)) + " m; expected metres");
  }
  return out;
}

std::vector<Vector3f> read_depth_points(const std::string& path) {
  std::vector<Vector3f> points;
  const HostCloud cloud = read_cloud(path);
  for (const std::array<float, 3>& p : cloud.points) {
    const Vector3f point(p[0], p[1], p[2]);
    if (point.allFinite() && depth_of(static_cast<double>(p[2])) > 0) points.push_back(point);
  }
  if (points.empty()) {
    throw InputError(path + ": of " + std::to_string(cloud.points.size()) +
                     " points, none is finite and less than " +
                     std::to_string(static_cast<int>(k_depth_max_m)) +
                     " m from the camera; expected metres in the camera's frame");
  }
  return points;
}

bool is_cloud_file(const std::string& path) {
  const std::string kind = kind_of(path);
  return kind == ".pcd" || kind == ".ply";
}

MaskImage read_mask(const std::string& path, const CameraModel& camera) {
  MaskImage out{camera.width, camera.height, {}};
  if (kind_of(path) == ".npy") {
    for (const double value : npy_picture(path, camera).values) out.on.push_back(value != 0);
  } else if (kind_of(path) == ".png") {
    const Image picture = png_picture(path, camera);
    if (picture.bits != 8) throw InputError(path + ": expected a mask of 8 bit");
    const auto channels = static_cast<std::size_t>(picture.channels);
    for (std::size_t i = 0; i < picture.values.size(); i += channels) {
      const auto* pixel = picture.values.data() + i;
      out.on.push_back(std::any_of(pixel, pixel + channels, [](int value) { return value != 0; }));
    }
  } else {
    throw InputError(path + ": expected a mask as .png or .npy");
  }
  if (std::all_of(out.on.begin(), out.on.end(), [](std::uint8_t on) { return on == 0; })) {
    throw InputError(path + ": no pixel is set; expected the robot's pixels");
  }
  return out;
}

}  // namespace glint
