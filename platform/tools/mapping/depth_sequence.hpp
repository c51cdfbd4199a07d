// Sequence of depth images with camera poses, from a folder.
//
// NAME.depth.png (16 bits per pixel, millimetres) or NAME.depth.npy (float32, metres); 0 is not
// measured. NAME.pose.txt: 16 numbers, T_world_camera row by row. camera-intrinsics.txt for all: 9
// numbers, a pinhole matrix for pixel centres at integers. NAME.left_out.txt (optional): one line
// per capsule (pen, arm) whose points are excluded from the map: x y z of one end, of the other,
// and the radius; metres, world frame.
#pragma once

#include <string>
#include <vector>

#include "kernels/cloud/depth_points.hpp"
#include "kernels/cloud/leave_out_capsules.hpp"

namespace glint {

struct DepthFrame {
  int width = 0, height = 0;
  std::vector<float> depth_m;
  Pose T_world_camera;
  std::vector<ExclusionCapsule>
      left_out;  // capsules of pen and hands at the image's time, world frame
  [[nodiscard]] DepthImageView picture() const { return {width, height, depth_m}; }
};

struct DepthSequence {
  CameraModel camera;
  std::vector<DepthFrame> frames;  // ordered by name
};

inline constexpr int k_depth_side_max = 4096;

// Returns an image without pose. Null: a PNG is rejected by name (build without OpenCV).
using DepthPngReader = DepthFrame (*)(const std::string& path);

// Throws InputError naming what is missing, or file, line, found and expected: a pose that is not
// rigid (beyond rounding), images of different sizes, no image.
[[nodiscard]] DepthSequence read_depth_sequence(const std::string& folder, DepthPngReader png);

}  // namespace glint
