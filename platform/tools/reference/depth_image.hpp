// Readers of depth images, point clouds and masks.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kernels/pose/camera_model.hpp"
#include "kernels/registration/triangle.hpp"

namespace glint {

struct DepthImage {
  int width = 0, height = 0;
  std::vector<float> z_m;  // row by row; 0 if not finite, negative, or too far
};

inline constexpr float k_depth_max_m = 20;

// Reads .npy (rows x columns, floating point metres or unsigned millimetres) or .png (16 bit,
// millimetres). Throws InputError, naming the file and what was expected, for a size other than the
// camera's and for an image without depth.
[[nodiscard]] DepthImage read_depth(const std::string& path, const CameraModel& camera);

// Returns whether the extension is that of a point cloud: .pcd or .ply.
[[nodiscard]] bool is_cloud_file(const std::string& path);

// Reads a cloud in the camera's frame (z forward), metres; keeps finite points with 0 < z <
// k_depth_max_m. Throws InputError if there are none.
[[nodiscard]] std::vector<Vector3f> read_depth_points(const std::string& path);

struct MaskImage {
  int width = 0, height = 0;
  std::vector<std::uint8_t> on;  // row by row: 0 or 1
};

// Reads .png or .npy of the camera's size: nonzero is the robot.
[[nodiscard]] MaskImage read_mask(const std::string& path, const CameraModel& camera);

}  // namespace glint
