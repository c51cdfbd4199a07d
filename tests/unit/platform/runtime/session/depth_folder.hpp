// Folder of depth images with poses, in the format that a session's mapping reads.
#pragma once

#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

#include "kernels/geometry.hpp"
#include "platform/formats/npy.hpp"

namespace glint {

struct DepthFolder {
  static constexpr int k_width = 80, k_height = 60;
  static constexpr double k_focal = 75;
  std::string path;
  int image_count = 0;

  explicit DepthFolder(const std::string& folder) : path(folder) {
    std::ofstream(path + "/camera-intrinsics.txt") << "75 0 39.5\n0 75 29.5\n0 0 1\n";
  }

  // Ray through the pixel's centre, z = 1.
  [[nodiscard]] static Vector3 ray(int pixel) {
    return {(pixel % k_width + 0.5 - 40) / k_focal, (pixel / k_width + 0.5 - 30) / k_focal, 1};
  }

  void add(const std::vector<float>& depth_m, const Pose& T_world_camera) {
    const std::string stem = path + "/" + std::to_string(100 + image_count++);
    std::ofstream(stem + ".depth.npy", std::ios::binary)
        << npy_float32_bytes({{k_height, k_width}, depth_m});
    std::ofstream pose(stem + ".pose.txt");
    pose.precision(17);
    const Matrix3 r = T_world_camera.rotation.toRotationMatrix();
    for (int i = 0; i < 3; ++i) {
      pose << r(i, 0) << ' ' << r(i, 1) << ' ' << r(i, 2) << ' ' << T_world_camera.translation(i)
           << '\n';
    }
    pose << "0 0 0 1\n";
  }

  // A wall and a floor, seen from positions side by side.
  void add_scene(int count) {
    for (int p = 0; p < count; ++p) {
      const Pose pose{Quaternion::Identity(), Vector3(0.02 * p, 0, 0.01 * p)};
      std::vector<float> depth;
      for (int i = 0; i < k_width * k_height; ++i) {
        const double wall = 1.5 - pose.translation.z(), down = ray(i).y();
        depth.push_back(static_cast<float>(down > 0 ? std::min(wall, 0.4 / down) : wall));
      }
      add(depth, pose);
    }
  }
};

}  // namespace glint
