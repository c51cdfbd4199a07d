// Renders a tool's spheres by ray casting, without noise, on a dark background.
#pragma once

#include <cmath>

#include "kernels/pose/tool.hpp"
#include "platform/formats/camera.hpp"
#include "platform/formats/frame_buffer.hpp"

namespace glint {

inline Tool small_tool() {
  Tool tool;
  tool.marker_count = 5;
  tool.markers_m = {Vector3(0, 0, 0), Vector3(0.09, 0, 0.01), Vector3(0.02, 0.07, 0),
                    Vector3(-0.05, 0.03, 0.03), Vector3(0.04, -0.055, 0.02)};
  tool.marker_radius_m = 0.006;
  tool.tip_m = {0, 0.15, 0};
  (void)prepare_tool(tool);
  return tool;
}

// Distance of the nearest surface point along the ray, or 0.
inline double sphere_range(const Vector3& ray, const Vector3& centre, double radius) {
  const double along = ray.dot(centre);
  const double square = along * along - centre.squaredNorm() + radius * radius;
  return square > 0 ? along - std::sqrt(square) : 0;
}

inline FrameBuffer rendered_frame(const Camera& camera, const Tool& tool,
                                  const Pose& T_camera_tool) {
  FrameBuffer buffer;
  buffer.width = camera.model.width;
  buffer.height = camera.model.height;
  const auto pixels = static_cast<std::size_t>(buffer.width * buffer.height);
  const bool wide = camera.reflectivity_bits == 16;
  if (wide)
    buffer.reflectivity_16.assign(pixels, 100);
  else
    buffer.reflectivity_8.assign(pixels, 40);
  buffer.depth.assign(pixels, 0);
  constexpr int samples = 4;
  for (int i = 0; i < tool.marker_count; ++i) {
    const Vector3 centre = T_camera_tool * tool.markers_m[static_cast<std::size_t>(i)];
    const Result<Vector2> middle = project(camera.model, centre);
    if (!middle) continue;
    const int x_middle = static_cast<int>(middle.value.x());
    const int y_middle = static_cast<int>(middle.value.y());
    for (int y = y_middle - 16; y <= y_middle + 16; ++y) {
      for (int x = x_middle - 16; x <= x_middle + 16; ++x) {
        if (x < 0 || y < 0 || x >= buffer.width || y >= buffer.height) continue;
        int hits = 0;
        double range_sum = 0;
        for (int s = 0; s < samples * samples; ++s) {
          const Vector2 at(x + (s % samples + 0.5) / samples, y + (s / samples + 0.5) / samples);
          const Result<Vector3> ray = unproject(camera.model, at);
          const double range = ray ? sphere_range(ray.value, centre, tool.marker_radius_m) : 0;
          hits += range > 0;
          range_sum += range;
        }
        if (hits == 0) continue;
        const auto index = static_cast<std::size_t>(y * buffer.width + x);
        const double part = static_cast<double>(hits) / (samples * samples);
        if (wide)
          buffer.reflectivity_16[index] = static_cast<std::uint16_t>(100 + 4000 * part);
        else
          buffer.reflectivity_8[index] =
              static_cast<std::uint8_t>(std::min(255.0, 40 + 600 * part));
        buffer.depth[index] =
            static_cast<std::uint16_t>(std::lround(range_sum / hits / camera.depth.unit_m));
      }
    }
  }
  return buffer;
}

inline Pose turned(double x_rad, double y_rad, double z_rad, const Vector3& translation) {
  const Quaternion rotation = Eigen::AngleAxisd(z_rad, Vector3::UnitZ()) *
                              Eigen::AngleAxisd(y_rad, Vector3::UnitY()) *
                              Eigen::AngleAxisd(x_rad, Vector3::UnitX());
  return {rotation, translation};
}

}  // namespace glint
