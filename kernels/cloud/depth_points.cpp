#include "kernels/cloud/depth_points.hpp"

namespace glint {
namespace {

int sampled_count(int pixels, int stride) { return (pixels + stride - 1) / stride; }

}  // namespace

int pixels_of(const DepthImageView& picture, int stride) noexcept {
  return sampled_count(picture.width, stride) * sampled_count(picture.height, stride);
}

int add_depth_points(const DepthImageView& picture, const CameraModel& camera,
                     const Pose& T_world_camera, const DepthPointSettings& settings, int from,
                     int count_max, PointCloud& points, int& dropped) noexcept {
  const Matrix3 rotation = T_world_camera.rotation.toRotationMatrix();
  const int columns = sampled_count(picture.width, settings.stride);
  const int end = std::min(pixels_of(picture, settings.stride), from + std::max(count_max, 0));
  for (int i = from; i < end; ++i) {
    const int u = i % columns * settings.stride, v = i / columns * settings.stride;
    const float depth = picture.depth_m[static_cast<std::size_t>(v * picture.width + u)];
    if (!(depth >= settings.depth_min_m && depth <= settings.depth_max_m)) continue;
    const Result<Vector3> ray = unproject(camera, Vector2(u + 0.5, v + 0.5));
    if (!ray) continue;
    const double length = settings.along == DepthAlong::ray
                              ? static_cast<double>(depth)
                              : static_cast<double>(depth) / ray.value.z();
    const Vector3 point = rotation * (ray.value * length) + T_world_camera.translation;
    if (!points.add(static_cast<float>(point.x()), static_cast<float>(point.y()),
                    static_cast<float>(point.z()))) {
      ++dropped;
    }
  }
  return end;
}

}  // namespace glint
