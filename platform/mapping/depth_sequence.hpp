// Depth pictures with the camera's pose, from a folder.
//
// NAME.depth.png (16 bits a pixel, millimetres) or NAME.depth.npy (float32, metres), beside it
// NAME.pose.txt (16 numbers, T_world_camera row by row), for all camera-intrinsics.txt (9 numbers,
// a pinhole's matrix for pixels whose centres are at integers). 0: nothing was measured.
// NAME.left_out.txt, which need not be there: a line for each thick line (pen, arm) whose points
// are not to be mapped: x y z of its one end, of its other, and its radius, metres, in the world.
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
  std::vector<LeftOut> left_out;  // the tracked pen and hands as this picture was taken, world
  [[nodiscard]] DepthPicture picture() const { return {width, height, depth_m}; }
};

struct DepthSequence {
  CameraModel camera;
  std::vector<DepthFrame> frames;  // by name
};

inline constexpr int k_depth_side_max = 4096;

// A picture without pose; null: PNG is refused by name, for a board has nothing to read it with.
using DepthPngReader = DepthFrame (*)(const std::string& path);

// Throws InputError naming what is missing, or file, line, found and expected: a pose that is not
// rigid (beyond what printing leaves), pictures of different sizes, no picture at all.
[[nodiscard]] DepthSequence read_depth_sequence(const std::string& folder, DepthPngReader png);

}  // namespace glint
