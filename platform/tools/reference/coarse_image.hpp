// Reduced image for the coarse pose search: sampled robot points, cells, scene normals.
#pragma once

#include <vector>

#include "kernels/registration/scene_view.hpp"
#include "platform/tools/reference/scene.hpp"

namespace glint {

inline constexpr int k_cell_pixels = 8;  // a cell's side

struct CoarseImage {
  SceneView view;
  std::vector<Vector3> points, normals;  // of the robot, base frame
  std::vector<Vector3f> scene_normals;   // of each pixel, unit length; zero at edges
  std::vector<int> mask_cells;           // cells covered by the mask to at least half

  [[nodiscard]] int cells() const;
  [[nodiscard]] int cell_of(int pixel) const;
};

// Samples this many points evenly over the robot's surface. Borrows the frame's memory.
[[nodiscard]] CoarseImage coarse_image(const SceneFrame& frame, int points);

}  // namespace glint
