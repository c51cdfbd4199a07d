#include "kernels/pose/camera_model.hpp"

#include <cmath>

#include "kernels/pose/ray_table.hpp"

namespace glint {
namespace {

// A residual of this size on the plane z = 1 is far below 1e-6 px for any focal length here.
constexpr double k_converged_square = 1e-26;

// A longer Newton step leaves the part of the lens where the polynomials are well behaved.
constexpr double k_step_max = 0.25;

struct Distorted {
  Vector2 position;  // on the plane z = 1
  double dxdx, dxdy, dydx, dydy;
};

// OpenCV's model: radial factor (1 + k1 r2 + k2 r4 + k3 r6) / (1 + k4 r2 + k5 r4 + k6 r6), then the
// tangential terms. With its Jacobian.
Distorted distort(const std::array<double, 8>& k, const Vector2& p, bool with_denominator) {
  const double x = p.x(), y = p.y(), r2 = x * x + y * y;
  const double top = 1 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]));
  const double top_slope = k[0] + r2 * (2 * k[1] + r2 * 3 * k[4]);
  const double bottom = with_denominator ? 1 + r2 * (k[5] + r2 * (k[6] + r2 * k[7])) : 1.0;
  const double bottom_slope = with_denominator ? k[5] + r2 * (2 * k[6] + r2 * 3 * k[7]) : 0.0;
  const double factor = top / bottom;
  const double slope = (top_slope - factor * bottom_slope) / bottom;  // d factor / d r2
  const double p1 = k[2], p2 = k[3];
  Distorted out;
  out.position = {x * factor + 2 * p1 * x * y + p2 * (r2 + 2 * x * x),
                  y * factor + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y};
  out.dxdx = factor + 2 * x * x * slope + 2 * p1 * y + 6 * p2 * x;
  out.dxdy = 2 * x * y * slope + 2 * p1 * x + 2 * p2 * y;
  out.dydx = out.dxdy;
  out.dydy = factor + 2 * y * y * slope + 6 * p1 * y + 2 * p2 * x;
  return out;
}

// Beyond its turning point a polynomial folds back: there two rays would share a pixel.
bool inside_lens(const CameraModel& camera, const Vector2& p, const Distorted& d) {
  const double limit = camera.field_tangent_max;
  if (limit > 0 && p.squaredNorm() > limit * limit) return false;
  return d.dxdx * d.dydy - d.dxdy * d.dydx > 0 && d.dxdx + d.dydy > 0;
}

Result<Vector2> undistort(const CameraModel& camera, const Vector2& target) {
  const bool rational = camera.lens == Lens::rational;
  Vector2 p = target;
  for (int i = 0; i < k_undistort_iterations_max; ++i) {
    const Distorted d = distort(camera.distortion, p, rational);
    const Vector2 miss = target - d.position;
    if (miss.squaredNorm() <= k_converged_square) {
      if (!inside_lens(camera, p, d)) break;
      return {p};
    }
    const double determinant = d.dxdx * d.dydy - d.dxdy * d.dydx;
    if (!(std::abs(determinant) > 1e-12)) break;
    Vector2 step{(d.dydy * miss.x() - d.dxdy * miss.y()) / determinant,
                 (d.dxdx * miss.y() - d.dydx * miss.x()) / determinant};
    const double length = std::sqrt(step.squaredNorm());
    if (length > k_step_max) step *= k_step_max / length;
    p += step;
  }
  return {Vector2::Zero(), Reason::out_of_range};
}

}  // namespace

Result<Vector3> unproject(const CameraModel& camera, const Vector2& pixel) noexcept {
  if (camera.lens == Lens::lut) return unproject(camera.table, pixel);
  Vector2 p{(pixel.x() - camera.cx) / camera.fx, (pixel.y() - camera.cy) / camera.fy};
  if (!(p.squaredNorm() < 1e6)) return {Vector3::Zero(), Reason::out_of_range};
  if (camera.lens != Lens::pinhole) {
    const Result<Vector2> found = undistort(camera, p);
    if (!found) return {Vector3::Zero(), found.reason};
    p = found.value;
  }
  const double length = std::sqrt(p.squaredNorm() + 1);
  return {Vector3{p.x() / length, p.y() / length, 1 / length}};
}

Result<Vector2> project(const CameraModel& camera, const Vector3& point) noexcept {
  int lens_steps = 0;
  return project(camera, point, lens_steps);
}

Result<Vector2> project(const CameraModel& camera, const Vector3& point, int& lens_steps) noexcept {
  if (!(point.z() > 0)) return {Vector2::Zero(), Reason::out_of_range};
  Vector2 p{point.x() / point.z(), point.y() / point.z()};
  if (!(p.squaredNorm() < 1e6)) return {Vector2::Zero(), Reason::out_of_range};
  if (camera.lens != Lens::pinhole) {
    const Distorted d = distort(camera.distortion, p, camera.lens != Lens::brown);
    if (camera.lens != Lens::lut && !inside_lens(camera, p, d)) {
      return {Vector2::Zero(), Reason::out_of_range};
    }
    p = d.position;
  }
  const Vector2 pixel{p.x() * camera.fx + camera.cx, p.y() * camera.fy + camera.cy};
  if (camera.lens == Lens::lut) {
    return project(camera.table, point, pixel, {camera.cx, camera.cy}, lens_steps);
  }
  return {pixel};
}

}  // namespace glint
