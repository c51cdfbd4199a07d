// Depth pictures, clouds and masks from files.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kernels/pose/camera_model.hpp"
#include "kernels/registration/triangle.hpp"

namespace glint {

struct DepthImage {
  int width = 0, height = 0;
  std::vector<float> z_m;  // row by row; 0 where there is none: not finite, negative, or too far
};

inline constexpr float k_depth_max_m = 20;

// .npy (rows x columns, floating point metres or unsigned millimetres) or .png (16 bit,
// millimetres). Throws InputError naming the file and what was expected: another size than the
// camera's, no depth at all.
[[nodiscard]] DepthImage read_depth(const std::string& path, const CameraModel& camera);

// Whether a file's ending is a cloud's: .pcd or .ply.
[[nodiscard]] bool is_cloud_file(const std::string& path);

// The points of a cloud in the camera's frame (z forward), metres: those that are finite and
// before the camera, k_depth_max_m away at most. Throws InputError: no such points.
[[nodiscard]] std::vector<Vector3f> read_depth_points(const std::string& path);

struct MaskPicture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> on;  // row by row: 0 or 1
};

// .png or .npy of the camera's size: not 0 is the robot.
[[nodiscard]] MaskPicture read_mask(const std::string& path, const CameraModel& camera);

}  // namespace glint
