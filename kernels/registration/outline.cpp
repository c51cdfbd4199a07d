#include "kernels/registration/outline.hpp"

#include <array>
#include <cmath>

namespace glint {

OutlineCounts count_outline(const SceneView& view, std::span<const float> model_z,
                            std::span<const std::int32_t> triangle, double far_m) noexcept {
  OutlineCounts counts;
  add_outline(view, model_z, triangle, far_m, 0, view.camera.width * view.camera.height, counts);
  return counts;
}

void add_outline(const SceneView& view, std::span<const float> model_z,
                 std::span<const std::int32_t> triangle, double far_m, int from, int to,
                 OutlineCounts& counts) noexcept {
  constexpr std::array<std::array<int, 2>, 4> sides{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
  const int width = view.camera.width, height = view.camera.height;
  const auto far = static_cast<float>(far_m);
  const auto inside = [&](int x, int y) { return x >= 0 && y >= 0 && x < width && y < height; };
  const auto at = [&](int x, int y) { return static_cast<std::size_t>(y * width + x); };
  for (int i = from; i < to; ++i) {
    const auto pixel = static_cast<std::size_t>(i);
    if (triangle[pixel] < 0) continue;
    const float z = view.depth_m[pixel];
    if (!(z > 0) || !(std::abs(z - model_z[pixel]) <= far)) continue;
    const int x = i % width, y = i / width;
    for (const auto& [right, down] : sides) {
      if (!inside(x + right, y + down) || triangle[at(x + right, y + down)] >= 0) continue;
      for (int d = k_outline_from; d <= k_outline_reach; ++d) {
        const int u = x + d * right, v = y + d * down;
        if (!inside(u, v) || triangle[at(u, v)] >= 0) break;
        const float beside = view.depth_m[at(u, v)];
        if (!(beside > 0)) continue;
        if (beside > z + far) ++counts.falls;
        if (std::abs(beside - z) <= far) ++counts.continues;
        break;
      }
    }
  }
}

}  // namespace glint
