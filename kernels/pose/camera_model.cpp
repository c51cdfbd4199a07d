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

struct Undistorted {
  Vector2 position = Vector2::Zero();  // on the plane z = 1
  Distorted there{};
};

// Adds the steps it took to `steps`.
Result<Undistorted> undistort(const CameraModel& camera, const Vector2& target, int steps_max,
                              int& steps) {
  const bool rational = camera.lens == Lens::rational;
  Vector2 p = target;
  for (int i = 0; i < steps_max; ++i) {
    ++steps;
    const Distorted d = distort(camera.distortion, p, rational);
    const Vector2 miss = target - d.position;
    if (miss.squaredNorm() <= k_converged_square) {
      if (!inside_lens(camera, p, d)) break;
      return {{p, d}};
    }
    const double determinant = d.dxdx * d.dydy - d.dxdy * d.dydx;
    if (!(std::abs(determinant) > 1e-12)) break;
    Vector2 step{(d.dydy * miss.x() - d.dxdy * miss.y()) / determinant,
                 (d.dxdx * miss.y() - d.dydx * miss.x()) / determinant};
    const double length = std::sqrt(step.squaredNorm());
    if (length > k_step_max) step *= k_step_max / length;
    p += step;
  }
  return {{}, Reason::out_of_range};
}

}  // namespace

Result<Vector3> unproject(const CameraModel& camera, const Vector2& pixel) noexcept {
  if (camera.lens == Lens::lut) return unproject(camera.table, pixel);
  Vector2 p{(pixel.x() - camera.cx) / camera.fx, (pixel.y() - camera.cy) / camera.fy};
  if (!(p.squaredNorm() < 1e6)) return {Vector3::Zero(), Reason::out_of_range};
  if (camera.lens != Lens::pinhole) {
    int steps = 0;
    const Result<Undistorted> found = undistort(camera, p, k_undistort_iterations_max, steps);
    if (!found) return {Vector3::Zero(), found.reason};
    p = found.value.position;
  }
  const double length = std::sqrt(p.squaredNorm() + 1);
  return {Vector3{p.x() / length, p.y() / length, 1 / length}};
}

Result<TurningRay> unproject_turning(const CameraModel& camera, const Vector2& pixel,
                                     int& lens_steps) noexcept {
  Vector2 p{(pixel.x() - camera.cx) / camera.fx, (pixel.y() - camera.cy) / camera.fy};
  if (!(p.squaredNorm() < 1e6)) return {{}, Reason::out_of_range};
  // The change of p by one pixel: the lens's Jacobian, inverted.
  Vector2 dx{1 / camera.fx, 0}, dy{0, 1 / camera.fy};
  if (camera.lens != Lens::pinhole) {
    const Result<Undistorted> found = undistort(camera, p, k_turning_ray_steps_max, lens_steps);
    if (!found) return {{}, found.reason};
    p = found.value.position;
    const Distorted& d = found.value.there;
    const double determinant = d.dxdx * d.dydy - d.dxdy * d.dydx;
    dx = Vector2{d.dydy, -d.dydx} / (determinant * camera.fx);
    dy = Vector2{-d.dxdy, d.dxdx} / (determinant * camera.fy);
  }
  const double length = std::sqrt(p.squaredNorm() + 1);
  TurningRay out;
  out.ray = {p.x() / length, p.y() / length, 1 / length};
  const auto across = [&](const Vector2& change) {
    const Vector3 moved{change.x() / length, change.y() / length, 0};
    return Vector3(moved - out.ray * out.ray.dot(moved));
  };
  out.along_x = across(dx);
  out.along_y = across(dy);
  return {out};
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
