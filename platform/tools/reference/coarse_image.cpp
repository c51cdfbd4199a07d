#include "platform/tools/reference/coarse_image.hpp"

#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

namespace glint {
namespace {

constexpr int k_normal_span = 3;          // pixels to each side
constexpr float k_normal_jump_m = 0.05f;  // a larger depth difference is an edge

// Samples evenly by area: one point in each of `count` equal parts of the area.
void sample_surface(const Surface& surface, int count, std::vector<Vector3>& points,
                    std::vector<Vector3>& normals) {
  std::vector<double> areas;
  for (std::size_t f = 0; f < surface.faces.size(); ++f) {
    const Triangle t = surface.triangle(f);
    areas.push_back(0.5 * static_cast<double>((t.b - t.a).cross(t.c - t.a).norm()));
  }
  const double total = std::accumulate(areas.begin(), areas.end(), 0.0);
  double cumulative_area = 0;
  int next = 0;
  for (std::size_t f = 0; f < areas.size(); ++f) {
    cumulative_area += areas[f];
    const Triangle t = surface.triangle(f);
    for (; next < count && (next + 0.5) * total / count < cumulative_area; ++next) {
      // Two-dimensional R sequence, folded into the triangle.
      double a = std::fmod(0.7548776662466927 * next, 1.0);
      double b = std::fmod(0.5698402909980532 * next, 1.0);
      if (a + b > 1) std::tie(a, b) = std::pair(1 - a, 1 - b);
      const Vector3 along = (t.b - t.a).cast<double>(), up = (t.c - t.a).cast<double>();
      points.push_back(t.a.cast<double>() + a * along + b * up);
      normals.push_back(along.cross(up).normalized());
    }
  }
}

void sample_cloud(const ModelCloud& cloud, int count, std::vector<Vector3>& points,
                  std::vector<Vector3>& normals) {
  for (int i = 0; i < count; ++i) {
    const std::size_t at =
        cloud.points.size() * static_cast<std::size_t>(i) / static_cast<std::size_t>(count);
    points.push_back(cloud.points[at].cast<double>());
    normals.push_back(cloud.normals[at].cast<double>());
  }
}

// Normals towards the camera, from the depths beside each pixel; zero at edges.
std::vector<Vector3f> normals_of(const SceneView& view) {
  const Pinhole& camera = view.camera;
  std::vector<Vector3f> normals(view.depth_m.size(), Vector3f::Zero());
  for (int y = k_normal_span; y < camera.height - k_normal_span; ++y) {
    for (int x = k_normal_span; x < camera.width - k_normal_span; ++x) {
      const auto at = [&](int u, int v) {
        return view.depth_m[static_cast<std::size_t>(v * camera.width + u)];
      };
      const float left = at(x - k_normal_span, y), right = at(x + k_normal_span, y);
      const float top = at(x, y - k_normal_span), bottom = at(x, y + k_normal_span);
      if (!(left > 0 && right > 0 && top > 0 && bottom > 0)) continue;
      if (std::abs(left - right) > k_normal_jump_m || std::abs(top - bottom) > k_normal_jump_m)
        continue;
      const Vector3f across = pixel_point(camera, x + k_normal_span, y, right) -
                              pixel_point(camera, x - k_normal_span, y, left);
      const Vector3f down = pixel_point(camera, x, y + k_normal_span, bottom) -
                            pixel_point(camera, x, y - k_normal_span, top);
      normals[static_cast<std::size_t>(y * camera.width + x)] = down.cross(across).normalized();
    }
  }
  return normals;
}

std::vector<int> mask_cells_of(const CoarseImage& picture) {
  const SceneView& view = picture.view;
  std::vector<int> cells, on(static_cast<std::size_t>(picture.cells()));
  for (std::size_t i = 0; i < view.mask.size(); ++i) {
    if (view.mask[i] == 0 || !(view.depth_m[i] > 0)) continue;
    ++on[static_cast<std::size_t>(picture.cell_of(static_cast<int>(i)))];
  }
  for (std::size_t cell = 0; cell < on.size(); ++cell) {
    if (2 * on[cell] >= k_cell_pixels * k_cell_pixels) cells.push_back(static_cast<int>(cell));
  }
  return cells;
}

}  // namespace

int CoarseImage::cells() const {
  const int across = (view.camera.width + k_cell_pixels - 1) / k_cell_pixels;
  return across * ((view.camera.height + k_cell_pixels - 1) / k_cell_pixels);
}

int CoarseImage::cell_of(int pixel) const {
  const int across = (view.camera.width + k_cell_pixels - 1) / k_cell_pixels;
  return pixel / view.camera.width / k_cell_pixels * across +
         pixel % view.camera.width / k_cell_pixels;
}

CoarseImage coarse_image(const SceneFrame& frame, int points) {
  CoarseImage picture{frame.view(), {}, {}, {}, {}};
  if (!frame.cloud.points.empty()) {
    sample_cloud(frame.cloud.cloud(), points, picture.points, picture.normals);
  } else {
    sample_surface(frame.model.surface(), points, picture.points, picture.normals);
  }
  picture.scene_normals = normals_of(picture.view);
  picture.mask_cells = mask_cells_of(picture);
  return picture;
}

}  // namespace glint
