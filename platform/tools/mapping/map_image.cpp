#include "platform/tools/mapping/map_image.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "platform/formats/image_file.hpp"

namespace glint {
namespace {

constexpr int k_splat = 3;  // half the width of a point, pixels

using Colour = std::array<std::uint8_t, 3>;  // red, green, blue

Colour colour_of(std::uint8_t plane, double facing) {
  static constexpr std::array<Colour, 8> colours{{{255, 160, 80},
                                                  {90, 200, 90},
                                                  {70, 150, 230},
                                                  {220, 90, 90},
                                                  {200, 100, 200},
                                                  {80, 210, 210},
                                                  {220, 200, 60},
                                                  {120, 120, 150}}};
  const bool on = plane != PlaneSearch::k_no_plane;
  Colour colour = on ? colours[plane % colours.size()] : Colour{170, 170, 170};
  for (std::uint8_t& part : colour) {
    part = static_cast<std::uint8_t>(part * (0.3 + 0.7 * facing));
  }
  return colour;
}

}  // namespace

void write_map_image(const std::string& path, const PointCloud& map, const PlaneSupport& planes,
                     const CameraModel& camera, const Pose& T_world_camera) {
  const auto pixels =
      static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
  std::vector<Colour> image(pixels, {30, 30, 30});
  std::vector<double> depth(pixels, std::numeric_limits<double>::infinity());
  const Pose T_camera_world = T_world_camera.inverse();
  for (int i = 0; i < map.count; ++i) {
    const Vector3 point =
        T_camera_world * Vector3(static_cast<double>(map.x[i]), static_cast<double>(map.y[i]),
                                 static_cast<double>(map.z[i]));
    if (!(point.z() > 0)) continue;
    const Result<Vector2> pixel = project(camera, point);
    if (!pixel) continue;
    const Vector3 normal(static_cast<double>(map.normal_x[i]), static_cast<double>(map.normal_y[i]),
                         static_cast<double>(map.normal_z[i]));
    const double facing = std::abs((T_camera_world.rotation * normal).dot(point.normalized()));
    const Colour colour = colour_of(planes.plane_of(i), std::min(facing, 1.0));
    const int u = static_cast<int>(std::floor(std::clamp(pixel.value.x(), -1e6, 1e6)));
    const int v = static_cast<int>(std::floor(std::clamp(pixel.value.y(), -1e6, 1e6)));
    for (int y = std::max(v - k_splat, 0); y <= std::min(v + k_splat, camera.height - 1); ++y) {
      for (int x = std::max(u - k_splat, 0); x <= std::min(u + k_splat, camera.width - 1); ++x) {
        const auto at = static_cast<std::size_t>(y) * static_cast<std::size_t>(camera.width) +
                        static_cast<std::size_t>(x);
        if (depth[at] <= point.z()) continue;
        depth[at] = point.z();
        image[at] = colour;
      }
    }
  }
  write_png(path, camera.width, camera.height, 3, image.data()->data(), "a writable path");
}

}  // namespace glint
