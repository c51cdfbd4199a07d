#include "kernels/registration/splat_cloud.hpp"

#include <algorithm>
#include <cmath>

namespace glint {
namespace {

struct Disc {
  Vector3f middle, normal;  // in the camera's frame
  float height = 0;         // of its plane over the camera: normal . middle
};

class Splatter {
 public:
  Splatter(const ModelCloud& model, const Pose& T_camera_model, const Pinhole& camera)
      : model_(model),
        camera_(camera),
        rotation_(T_camera_model.rotation.toRotationMatrix().cast<float>()),
        translation_(T_camera_model.translation.cast<float>()) {}

  [[nodiscard]] Disc disc(std::size_t point) const {
    Disc disc;
    disc.middle = rotation_ * model_.points[point] + translation_;
    disc.normal = rotation_ * model_.normals[point];
    disc.height = disc.normal.dot(disc.middle);
    return disc;
  }

  // Where the ray of a pixel's middle meets the disc's plane, if within so many spacings of the
  // disc's middle: its z, else 0.
  [[nodiscard]] float met(const Disc& disc, int x, int y, float radius) const {
    const Vector3f ray = pixel_point(camera_, x, y, 1.0f);
    const float along = disc.normal.dot(ray);
    if (!(std::abs(along) > 0)) return 0;
    const float z = disc.height / along;
    const float reach = radius * model_.spacing_m;
    if (!(z > static_cast<float>(k_render_near_m))) return 0;
    return (z * ray - disc.middle).squaredNorm() <= reach * reach ? z : 0;
  }

  void splat(std::size_t point, const Disc& disc, int reach, const DepthBuffer& buffer) const {
    const ProjectedCorner& at = buffer.corners[point];
    const int u = static_cast<int>(at.u), v = static_cast<int>(at.v);
    for (int y = std::max(0, v - reach); y <= std::min(camera_.height - 1, v + reach); ++y) {
      for (int x = std::max(0, u - reach); x <= std::min(camera_.width - 1, u + reach); ++x) {
        const float z = met(disc, x, y, k_disc_radius);
        if (!(z > 0)) continue;
        const auto pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(camera_.width) +
                           static_cast<std::size_t>(x);
        const std::int32_t had = buffer.triangle[pixel];
        if (had >= 0 &&
            !wins(at, z, buffer.corners[static_cast<std::size_t>(had)], buffer.z_m[pixel], x, y)) {
          continue;
        }
        buffer.z_m[pixel] = z;
        buffer.triangle[pixel] = static_cast<std::int32_t>(point);
      }
    }
  }

 private:
  [[nodiscard]] bool wins(const ProjectedCorner& a, float z_a, const ProjectedCorner& b, float z_b,
                          int x, int y) const {
    if (std::abs(z_a - z_b) > model_.spacing_m) return z_a < z_b;
    const auto away = [&](const ProjectedCorner& c) {
      const double du = c.u - x - 0.5, dv = c.v - y - 0.5;
      return du * du + dv * dv;
    };
    return away(a) < away(b);
  }

  const ModelCloud& model_;
  const Pinhole& camera_;
  Eigen::Matrix3f rotation_;
  Vector3f translation_;
};

}  // namespace

Reason splat_cloud(const ModelCloud& model, const Pose& T_camera_model, const Pinhole& camera,
                   const DepthBuffer& buffer) noexcept {
  const std::int64_t pixels = std::int64_t{camera.width} * camera.height;
  if (camera.width < 1 || camera.height < 1 ||
      buffer.z_m.size() != static_cast<std::size_t>(pixels) ||
      buffer.triangle.size() != buffer.z_m.size() || model.points.size() != model.normals.size() ||
      buffer.corners.size() < model.points.size() || model.points.size() > k_model_points_max) {
    return Reason::out_of_range;
  }
  std::fill(buffer.z_m.begin(), buffer.z_m.end(), 0.0f);
  std::fill(buffer.triangle.begin(), buffer.triangle.end(), -1);
  const Splatter splatter(model, T_camera_model, camera);
  std::int64_t tests_left = pixels * k_splat_tests_a_pixel;
  for (std::size_t i = 0; i < model.points.size(); ++i) {
    const Disc disc = splatter.disc(i);
    ProjectedCorner& at = buffer.corners[i];
    at = ProjectedCorner{};
    const auto z = static_cast<double>(disc.middle.z());
    if (!(z > k_render_near_m)) continue;
    at = {camera.fx * static_cast<double>(disc.middle.x()) / z + camera.cx,
          camera.fy * static_cast<double>(disc.middle.y()) / z + camera.cy, 1 / z};
    const double radius =
        static_cast<double>(k_disc_radius * model.spacing_m) * std::max(camera.fx, camera.fy) / z;
    const int reach = 1 + static_cast<int>(std::min<double>(radius, k_splat_reach - 1));
    if (!(at.u >= -reach && at.v >= -reach && at.u < camera.width + reach &&
          at.v < camera.height + reach)) {
      continue;
    }
    tests_left -= (2 * reach + 1) * (2 * reach + 1);
    if (tests_left < 0) return Reason::search_full;
    splatter.splat(i, disc, reach, buffer);
  }
  return Reason::none;
}

int seen_cloud_points(const SceneView& view, const Pose& T_camera_base, int step,
                      const DepthBuffer& buffer, std::span<SeenPoint> points) noexcept {
  const Pinhole& camera = view.camera;
  const Reason reason = splat_cloud(view.cloud, T_camera_base, camera, buffer);
  if (reason == Reason::out_of_range || step < 1) return 0;
  const Splatter splatter(view.cloud, T_camera_base, camera);
  std::size_t count = 0;
  for (int y = step / 2; y < camera.height; y += step) {
    for (int x = step / 2; x < camera.width; x += step) {
      const int pixel = y * camera.width + x;
      const std::int32_t number = buffer.triangle[static_cast<std::size_t>(pixel)];
      if (number < 0) continue;
      if (count == points.size()) return static_cast<int>(count);
      const Disc disc = splatter.disc(static_cast<std::size_t>(number));
      const float z = splatter.met(disc, x, y, k_seen_radius);
      if (!(z > 0)) continue;
      points[count].point = pixel_point(camera, x, y, z);
      points[count].normal = disc.height > 0 ? Vector3f(-disc.normal) : disc.normal;
      points[count].pixel = pixel;
      ++count;
    }
  }
  return static_cast<int>(count);
}

}  // namespace glint
