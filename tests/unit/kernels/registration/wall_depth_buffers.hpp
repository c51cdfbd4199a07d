// A small depth image to render into, and a tilted wall.
#pragma once

#include <vector>

#include "kernels/registration/render_depth.hpp"

namespace glint::test {

struct DepthBuffers {
  Pinhole camera{64, 48, 60, 60, 32, 24};
  std::vector<float> z = std::vector<float>(64 * 48);
  std::vector<std::int32_t> face = std::vector<std::int32_t>(64 * 48);
  std::vector<ProjectedCorner> corners = std::vector<ProjectedCorner>(64);

  Reason render(const std::vector<Vector3f>& points, const std::vector<Face>& faces,
                const Pose& pose = {}) {
    return render_depth({points, faces}, pose, camera, {z, face, corners});
  }
  [[nodiscard]] std::size_t at(int x, int y) const { return static_cast<std::size_t>(y * 64 + x); }
};

// Tilted wall: z = 1 + x / 2.
inline const std::vector<Vector3f> k_wall = {
    {-1, -2, 0.5f}, {1, -2, 1.5f}, {1, 2, 1.5f}, {-1, 2, 0.5f}};
inline const std::vector<Face> k_wall_faces = {{0, 1, 2}, {0, 2, 3}};

}  // namespace glint::test
