#include "platform/sim/capsule.hpp"

#include <cmath>

namespace glint::sim {
namespace {

Hit trace_ball(const Vector3& centre, double radius, const Vector3& ray) {
  const double along = ray.dot(centre);
  const double square = along * along - centre.squaredNorm() + radius * radius;
  if (square < 0) return {};
  const double range = along - std::sqrt(square);
  if (range <= 0) return {};
  return {range, -ray.dot(range * ray - centre) / radius};
}

double clamped(double x) { return x < 0 ? 0 : x > 1 ? 1 : x; }

}  // namespace

Hit TracedCapsule::trace_near(const Vector3& unit_ray, double range, double ray_axis) const {
  if (range > 0) {
    const double place = (range * ray_axis - start_axis_) / length2_;
    if (place >= 0 && place <= 1) {
      const Vector3 normal = range * unit_ray - (capsule_.a + place * axis_);
      return {range, -unit_ray.dot(normal) / capsule_.radius_m};
    }
  }
  const Hit first = trace_ball(capsule_.a, capsule_.radius_m, unit_ray);
  const Hit second = trace_ball(capsule_.b, capsule_.radius_m, unit_ray);
  if (!first) return second;
  if (!second) return first;
  return first.range_m < second.range_m ? first : second;
}

// Alternating projection onto the two segments, from the closest pair of the infinite lines. Exact
// if one clamp is active; otherwise the error is within the capsule's radius, sufficient for a
// preselection.
double axis_distance(const Capsule& capsule, const Vector3& end) {
  const Vector3 axis = capsule.b - capsule.a;
  const double length2 = axis.squaredNorm(), end2 = end.squaredNorm();
  if (end2 <= 0) return capsule.a.norm();
  const double across = axis.dot(end);
  const double determinant = length2 * end2 - across * across;
  double s = 0;
  if (determinant > 1e-15) {
    s = clamped((across * end.dot(capsule.a) - end2 * axis.dot(capsule.a)) / determinant);
  }
  double u = 0;
  for (int i = 0; i < 2; ++i) {
    u = clamped((capsule.a + s * axis).dot(end) / end2);
    if (length2 > 0) s = clamped((u * end - capsule.a).dot(axis) / length2);
  }
  return (capsule.a + s * axis - u * end).norm();
}

Capsule transformed(const Pose& T_a_b, const Capsule& in_b) {
  return {T_a_b * in_b.a, T_a_b * in_b.b, in_b.radius_m, in_b.signal};
}

}  // namespace glint::sim
