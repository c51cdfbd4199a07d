#include "kernels/pose/sphere_shift.hpp"

#include <algorithm>
#include <cmath>

namespace glint {
namespace {

// Step of the finite differences for the lens's slope and curvature: wide enough for the noise of a
// table of single-precision rays, narrow enough for all known lenses.
constexpr double k_step_px = 6;
// At the axis itself the terms cancel: its gain is computed at this distance.
constexpr double k_nearest_px = 24;

// Angle between two unit rays close to each other; the series' next term is below 1e-9 of it.
double angle_between(const Vector3& a, const Vector3& b) {
  const double sine = a.cross(b).norm(), square = sine * sine;
  return sine * (1 + square * (1.0 / 6 + square * (3.0 / 40)));
}

// h: the distance from the axis as a function of the angle; its derivatives are computed from the
// inverse's. Returns false if the lens has no ray there.
bool gain_towards(const CameraModel& camera, const Vector2& direction, double h, double& gain) {
  const auto ray_at = [&](double distance) {
    return unproject(camera, Vector2(camera.cx, camera.cy) + distance * direction);
  };
  const Result<Vector3> inner = ray_at(h - k_step_px), middle = ray_at(h),
                        outer = ray_at(h + k_step_px);
  if (!inner || !middle || !outer) return false;
  const double before = angle_between(inner.value, middle.value);
  const double after = angle_between(middle.value, outer.value);
  const double slope = (before + after) / (2 * k_step_px);
  const double curvature = (after - before) / (k_step_px * k_step_px);
  const double sine = middle.value.head<2>().norm();
  if (!(slope > 1e-9) || !(sine > 1e-3)) return false;
  const double h1 = 1 / slope, h2 = -curvature * h1 * h1 * h1;
  const double cotangent = middle.value.z() / sine;
  // The mean of a cap's squared offsets along an axis is a quarter of its squared radius.
  const double shift =
      0.25 * (1.5 * h2 - 0.5 * h1 * cotangent - 0.5 * h / (sine * sine) + h1 * h1 / h);
  gain = shift / h;
  return true;
}

double farthest_corner_square(const CameraModel& camera) {
  const double x = std::max(std::abs(camera.cx), std::abs(camera.width - camera.cx));
  const double y = std::max(std::abs(camera.cy), std::abs(camera.height - camera.cy));
  return x * x + y * y;
}

}  // namespace

SphereOffset sphere_offset(const CameraModel& camera) noexcept {
  SphereOffset out;
  out.axis_px = {camera.cx, camera.cy};
  const double most = farthest_corner_square(camera);
  if (!(most > 0)) return out;
  out.entries_per_square_px = (k_sphere_shift_entries - 1) / most;
  double last = 0;
  for (int i = 0; i < k_sphere_shift_entries; ++i) {
    const double h = std::max(std::sqrt(i / out.entries_per_square_px), k_nearest_px);
    double sum = 0;
    int found = 0;
    for (const Vector2& direction :
         {Vector2(1, 0), Vector2(-1, 0), Vector2(0, 1), Vector2(0, -1)}) {
      double gain = 0;
      if (!gain_towards(camera, direction, h, gain)) continue;
      sum += gain;
      ++found;
    }
    if (found > 0) last = sum / found;  // beyond the lens: as at its rim
    out.gain[static_cast<std::size_t>(i)] = last;
  }
  return out;
}

Vector2 offset_px(const SphereOffset& shift, const Vector2& centroid_px, double sine) noexcept {
  const Vector2 beside = centroid_px - shift.axis_px;
  const double place = std::clamp(beside.squaredNorm() * shift.entries_per_square_px, 0.0,
                                  static_cast<double>(k_sphere_shift_entries - 1));
  const auto i = std::min(static_cast<std::size_t>(place),
                          static_cast<std::size_t>(k_sphere_shift_entries - 2));
  const double part = place - static_cast<double>(i);
  const double gain = shift.gain[i] + part * (shift.gain[i + 1] - shift.gain[i]);
  return sine * sine * gain * beside;
}

}  // namespace glint
