#include "kernels/pose/camera_model.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/pose/ray_table.hpp"

namespace glint {
namespace {

// Newton's error after a step is about the step's square: a step of this size leaves less than
// 1e-12 on the plane z = 1, far below 1e-6 px for any focal length here. No further step confirms
// it.
constexpr double k_last_step_square = 1e-14;

// Maximum Newton step: a longer one leaves the region where the polynomials are well behaved.
constexpr double k_step_max = 0.25;

struct Distorted {
  Vector2 position;  // on the plane z = 1
  double dxdx, dxdy, dydx, dydy;
};

// OpenCV's distortion model with its Jacobian: radial factor (1 + k1 r2 + k2 r4 + k3 r6) / (1 + k4
// r2 + k5 r4 + k6 r6), then the tangential terms.
Distorted polynomial(const std::array<double, 8>& k, const Vector2& p, bool with_denominator) {
  const double x = p.x(), y = p.y(), r2 = x * x + y * y;
  const double top = 1 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]));
  const double top_slope = k[0] + r2 * (2 * k[1] + r2 * 3 * k[4]);
  const double bottom = with_denominator ? 1 + r2 * (k[5] + r2 * (k[6] + r2 * k[7])) : 1.0;
  const double bottom_slope = with_denominator ? k[5] + r2 * (2 * k[6] + r2 * 3 * k[7]) : 0.0;
  const double factor = top / bottom;
  const double inverse = with_denominator ? 1 / bottom : 1.0;          // independent division
  const double slope = (top_slope - factor * bottom_slope) * inverse;  // d factor / d r2
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

Distorted distort(const CameraModel& camera, const Vector2& p) {
  bool with_denominator = true;
  switch (camera.lens) {
    case Lens::pinhole:
      return {p, 1, 0, 0, 1};
    case Lens::brown:
      with_denominator = false;
      break;
    case Lens::rational:
    case Lens::lut:
      break;
  }
  return polynomial(camera.distortion, p, with_denominator);
}

double determinant_of(const Distorted& d) { return d.dxdx * d.dydy - d.dxdy * d.dydx; }

// Beyond its turning point a polynomial folds back: two rays would share a pixel there.
bool inside_lens(const CameraModel& camera, const Vector2& p, const Distorted& d) {
  const double limit = camera.field_tangent_max;
  if (limit > 0 && p.squaredNorm() > limit * limit) return false;
  return determinant_of(d) > 0 && d.dxdx + d.dydy > 0;
}

// Initial guess: the distorted point divided by the radial factor there; it is closer to the
// solution than the distorted point.
Vector2 first_guess(const std::array<double, 8>& k, const Vector2& target, bool with_denominator) {
  const double r2 = target.squaredNorm();
  const double top = 1 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]));
  const double bottom = with_denominator ? 1 + r2 * (k[5] + r2 * (k[6] + r2 * k[7])) : 1.0;
  // Clamped, because the polynomials may have any value outside the lens.
  return target * std::clamp(bottom / std::max(top, 0.1), 0.25, 4.0);
}

struct Undistorted {
  Vector2 position = Vector2::Zero();  // on the plane z = 1
  Distorted there{};                   // one step before `position`: close enough
};

// Newton's method from an initial guess p. Adds the steps taken to `steps`.
template <class Distortion>
Reason invert(const Distortion& distorted, const CameraModel& camera, const Vector2& target,
              Vector2 p, int steps_max, int& steps, Undistorted& out) {
  for (int i = 0; i < steps_max; ++i) {
    ++steps;
    const Distorted d = distorted(p);
    const Vector2 miss = target - d.position;
    const double determinant = determinant_of(d);
    if (!(std::abs(determinant) > 1e-12)) break;
    const double inverse = 1 / determinant;
    Vector2 step{(d.dydy * miss.x() - d.dxdy * miss.y()) * inverse,
                 (d.dxdx * miss.y() - d.dydx * miss.x()) * inverse};
    const double square = step.squaredNorm();
    if (square <= k_last_step_square) {
      out.position = p + step;
      out.there = d;
      return inside_lens(camera, out.position, d) ? Reason::none : Reason::out_of_range;
    }
    if (square > k_step_max * k_step_max) step *= k_step_max / std::sqrt(square);
    p += step;
  }
  return Reason::out_of_range;
}

Reason undistort(const CameraModel& camera, const Vector2& target, int steps_max, int& steps,
                 Undistorted& out) {
  const std::array<double, 8>& k = camera.distortion;
  switch (camera.lens) {
    case Lens::brown:
      return invert([&k](const Vector2& p) { return polynomial(k, p, false); }, camera, target,
                    first_guess(k, target, false), steps_max, steps, out);
    case Lens::rational:
      return invert([&k](const Vector2& p) { return polynomial(k, p, true); }, camera, target,
                    first_guess(k, target, true), steps_max, steps, out);
    case Lens::pinhole:
    case Lens::lut:
      break;
  }
  return Reason::out_of_range;  // no Newton search: ray_search_of
}

}  // namespace

Result<Vector3> unproject(const CameraModel& camera, const Vector2& pixel) noexcept {
  const RaySearch search = ray_search_of(camera.lens);
  if (search == RaySearch::table) return unproject(camera.table, pixel);
  Vector2 p{(pixel.x() - camera.cx) / camera.fx, (pixel.y() - camera.cy) / camera.fy};
  if (!(p.squaredNorm() < 1e6)) return {Vector3::Zero(), Reason::out_of_range};
  if (search == RaySearch::newton) {
    int steps = 0;
    Undistorted found;
    const Reason reason = undistort(camera, p, k_ray_steps_max, steps, found);
    if (reason != Reason::none) return {Vector3::Zero(), reason};
    p = found.position;
  }
  const double length = std::sqrt(p.squaredNorm() + 1);
  return {Vector3{p.x() / length, p.y() / length, 1 / length}};
}

Result<RayJacobian> unproject_with_jacobian(const CameraModel& camera, const Vector2& pixel,
                                            int steps_max, int& lens_steps) noexcept {
  Vector2 p{(pixel.x() - camera.cx) / camera.fx, (pixel.y() - camera.cy) / camera.fy};
  if (!(p.squaredNorm() < 1e6)) return {{}, Reason::out_of_range};
  // Derivative of p by the pixel: the lens's Jacobian, inverted.
  Vector2 dx{1 / camera.fx, 0}, dy{0, 1 / camera.fy};
  if (ray_search_of(camera.lens) != RaySearch::none) {
    Undistorted found;
    const Reason reason = undistort(camera, p, steps_max, lens_steps, found);
    if (reason != Reason::none) return {{}, reason};
    p = found.position;
    const Distorted& d = found.there;
    const double inverse = 1 / determinant_of(d);
    dx = Vector2{d.dydy, -d.dydx} * (inverse * dx.x());
    dy = Vector2{-d.dxdy, d.dxdx} * (inverse * dy.y());
  }
  const double shrink = 1 / std::sqrt(p.squaredNorm() + 1);
  Result<RayJacobian> out;
  const Vector3 ray{p.x() * shrink, p.y() * shrink, shrink};
  // Component of a change on the plane z = 1 that is perpendicular to the ray.
  const auto across = [&](const Vector2& change) {
    const Vector3 moved{change.x() * shrink, change.y() * shrink, 0};
    return Vector3(moved - ray * (ray.x() * moved.x() + ray.y() * moved.y()));
  };
  out.value = {ray, across(dx), across(dy)};
  return out;
}

Result<Vector2> project(const CameraModel& camera, const Vector3& point) noexcept {
  int lens_steps = 0;
  return project(camera, point, lens_steps);
}

Result<Vector2> project(const CameraModel& camera, const Vector3& point, int& lens_steps) noexcept {
  if (!(point.z() > 0)) return {Vector2::Zero(), Reason::out_of_range};
  Vector2 p{point.x() / point.z(), point.y() / point.z()};
  if (!(p.squaredNorm() < 1e6)) return {Vector2::Zero(), Reason::out_of_range};
  const RaySearch search = ray_search_of(camera.lens);
  if (search != RaySearch::none) {
    const Distorted d = distort(camera, p);
    if (search == RaySearch::newton && !inside_lens(camera, p, d)) {
      return {Vector2::Zero(), Reason::out_of_range};
    }
    p = d.position;
  }
  const Vector2 pixel{p.x() * camera.fx + camera.cx, p.y() * camera.fy + camera.cy};
  if (search == RaySearch::table) {
    return project(camera.table, point, pixel, {camera.cx, camera.cy}, lens_steps);
  }
  return {pixel};
}

}  // namespace glint
