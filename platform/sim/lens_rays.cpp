#include "platform/sim/lens_rays.hpp"

namespace glint::sim {

LensRays::LensRays(const CameraModel& model) : width_(model.width), height_(model.height) {
  const std::size_t count = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  rays_.resize(count);
  z_.resize(count);
  mask_.resize(count);
  fallback_.right = Vector3::UnitX() / model.fx;
  fallback_.down = Vector3::UnitY() / model.fy;
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      const Result<Vector3> found = unproject(model, {x + 0.5, y + 0.5});
      if (!found) continue;
      const Vector3 unit = found.value.normalized();
      rays_[at(x, y)] = {static_cast<float>(unit.x()), static_cast<float>(unit.y()),
                         static_cast<float>(unit.z())};
      z_[at(x, y)] = static_cast<float>(unit.z());
      mask_[at(x, y)] = 0xFFFF;
    }
  }
}

double LensRays::Slopes::finest_rad() const {
  const double a = right.norm(), b = down.norm();
  return a < b ? a : b;
}

double LensRays::Slopes::coarsest_rad() const {
  const double a = right.norm(), b = down.norm();
  return a < b ? b : a;
}

LensRays::Slopes LensRays::slopes(int x, int y) const {
  if (x < 1 || y < 1 || x + 1 >= width_ || y + 1 >= height_) return fallback_;
  if (!has_ray(x - 1, y) || !has_ray(x + 1, y) || !has_ray(x, y - 1) || !has_ray(x, y + 1)) {
    return fallback_;
  }
  return {0.5 * (ray(x + 1, y) - ray(x - 1, y)), 0.5 * (ray(x, y + 1) - ray(x, y - 1))};
}

}  // namespace glint::sim
