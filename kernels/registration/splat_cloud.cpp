#include "kernels/registration/splat_cloud.hpp"

#include <algorithm>
#include <cmath>

namespace glint {
namespace {

struct Disc {
  Vector3f middle, normal;  // centre and normal, camera frame
  float height = 0;         // distance of its plane from the camera: normal . middle
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

  // Intersects the ray of a pixel's centre with the disc's plane. Returns z if the point is within
  // `radius` spacings of the disc's centre, else 0.
  [[nodiscard]] float intersect(const Disc& disc, int x, int y, float radius) const {
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
        const float z = intersect(disc, x, y, k_disc_radius);
        if (!(z > 0)) continue;
        const auto pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(camera_.width) +
                           static_cast<std::size_t>(x);
        const std::int32_t previous = buffer.triangle[pixel];
        if (previous >= 0 && !wins(at, z, buffer.corners[static_cast<std::size_t>(previous)],
                                   buffer.z_m[pixel], x, y)) {
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

Reason CloudSplat::start(const ModelCloud& model, const Pose& T_camera_model, const Pinhole& camera,
                         int raster, const DepthBuffer& buffer,
                         std::span<VisiblePoint> points) noexcept {
  model_ = model, T_camera_model_ = T_camera_model, camera_ = camera, raster_ = raster;
  buffer_ = buffer, points_ = points;
  const std::int64_t pixels = std::int64_t{camera.width} * camera.height;
  count_ = 0;
  at_ = 0;
  tests_left_ = pixels * k_splat_tests_per_pixel;
  const bool fits =
      camera.width >= 1 && camera.height >= 1 &&
      buffer.z_m.size() == static_cast<std::size_t>(pixels) &&
      buffer.triangle.size() == buffer.z_m.size() && model.points.size() == model.normals.size() &&
      buffer.corners.size() >= model.points.size() && model.points.size() <= k_model_points_max;
  phase_ = fits ? Phase::clear : Phase::done;
  reason_ = fits ? Reason::none : Reason::out_of_range;
  return reason_;
}

bool CloudSplat::step(StepBudget& budget) noexcept {
  if (phase_ == Phase::clear) {
    const auto pixels = static_cast<int>(buffer_.z_m.size());
    const int from = at_;
    at_ += static_cast<int>(std::min<std::int64_t>(
        pixels - at_, std::max<std::int64_t>(budget.left(), 1) * k_splat_cleared_per_step));
    budget.take(1 + (at_ - from) / k_splat_cleared_per_step);
    std::fill(buffer_.z_m.begin() + from, buffer_.z_m.begin() + at_, 0.0f);
    std::fill(buffer_.triangle.begin() + from, buffer_.triangle.begin() + at_, -1);
    if (at_ < pixels) return false;
    at_ = 0;
    phase_ = Phase::splat;
  } else if (phase_ == Phase::splat) {
    splat_points(budget);
  } else if (phase_ == Phase::gather) {
    gather_points(budget);
  }
  return phase_ == Phase::done;
}

void CloudSplat::splat_points(StepBudget& budget) noexcept {
  const Splatter splatter(model_, T_camera_model_, camera_);
  const auto end = static_cast<int>(model_.points.size());
  for (; at_ < end && !budget.spent(); ++at_) {
    const auto i = static_cast<std::size_t>(at_);
    const Disc disc = splatter.disc(i);
    budget.take(k_splat_point_steps);
    ProjectedCorner& at = buffer_.corners[i];
    at = ProjectedCorner{};
    const auto z = static_cast<double>(disc.middle.z());
    if (!(z > k_render_near_m)) continue;
    at = {camera_.fx * static_cast<double>(disc.middle.x()) / z + camera_.cx,
          camera_.fy * static_cast<double>(disc.middle.y()) / z + camera_.cy, 1 / z};
    const double radius = static_cast<double>(k_disc_radius * model_.spacing_m) *
                          std::max(camera_.fx, camera_.fy) / z;
    const int reach = 1 + static_cast<int>(std::min<double>(radius, k_splat_reach - 1));
    if (!(at.u >= -reach && at.v >= -reach && at.u < camera_.width + reach &&
          at.v < camera_.height + reach)) {
      continue;
    }
    const int tests = (2 * reach + 1) * (2 * reach + 1);
    tests_left_ -= tests;
    if (tests_left_ < 0) {
      reason_ = Reason::search_full;
      at_ = end;
      break;
    }
    budget.take(tests * k_splat_test_steps);
    splatter.splat(i, disc, reach, buffer_);
  }
  if (at_ < end) return;
  at_ = raster_ / 2 * camera_.width + raster_ / 2;
  const bool some = raster_ >= 1 && raster_ / 2 < camera_.width && !points_.empty();
  phase_ = some ? Phase::gather : Phase::done;
}

void CloudSplat::gather_points(StepBudget& budget) noexcept {
  const Splatter splatter(model_, T_camera_model_, camera_);
  const int pixels = camera_.width * camera_.height;
  const auto next = [&](int pixel) {
    const int x = pixel % camera_.width + raster_;
    return x < camera_.width ? pixel + raster_
                             : (pixel / camera_.width + raster_) * camera_.width + raster_ / 2;
  };
  for (; at_ < pixels && !budget.spent(); at_ = next(at_)) {
    budget.take(k_splat_pixel_steps);
    const std::int32_t number = buffer_.triangle[static_cast<std::size_t>(at_)];
    if (number < 0) continue;
    if (count_ == points_.size()) break;
    budget.take(k_splat_visible_steps);
    const int x = at_ % camera_.width, y = at_ / camera_.width;
    const Disc disc = splatter.disc(static_cast<std::size_t>(number));
    const float z = splatter.intersect(disc, x, y, k_visible_radius);
    if (!(z > 0)) continue;
    points_[count_].point = pixel_point(camera_, x, y, z);
    points_[count_].normal = disc.height > 0 ? Vector3f(-disc.normal) : disc.normal;
    points_[count_].pixel = at_;
    ++count_;
  }
  if (at_ >= pixels || count_ == points_.size()) phase_ = Phase::done;
}

Reason splat_cloud(const ModelCloud& model, const Pose& T_camera_model, const Pinhole& camera,
                   const DepthBuffer& buffer) noexcept {
  CloudSplat run;
  if (const Reason reason = run.start(model, T_camera_model, camera, 1, buffer, {});
      reason != Reason::none) {
    return reason;
  }
  for (StepBudget all; !run.step(all); all = StepBudget()) {
  }
  return run.reason();
}

int visible_cloud_points(const SceneView& view, const Pose& T_camera_base, int step,
                         const DepthBuffer& buffer, std::span<VisiblePoint> points) noexcept {
  CloudSplat run;
  if (run.start(view.cloud, T_camera_base, view.camera, step, buffer, points) != Reason::none) {
    return 0;
  }
  for (StepBudget all; !run.step(all); all = StepBudget()) {
  }
  return run.count();
}

}  // namespace glint
