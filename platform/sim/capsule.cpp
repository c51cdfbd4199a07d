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

// Solves the quadratic of an infinite cylinder, with the axial components of ray and centre
// removed. If the hit is beyond an end, the sphere of that end applies.
Hit trace(const Capsule& capsule, const Vector3& ray) {
  const Vector3 axis = capsule.b - capsule.a;
  const double length2 = axis.squaredNorm();
  if (length2 > 0) {
    const double ray_axis = ray.dot(axis), start_axis = capsule.a.dot(axis);
    const double a = length2 - ray_axis * ray_axis;
    const double b = length2 * ray.dot(capsule.a) - ray_axis * start_axis;
    const double c = length2 * (capsule.a.squaredNorm() - capsule.radius_m * capsule.radius_m) -
                     start_axis * start_axis;
    const double square = b * b - a * c;
    if (a > 1e-12 * length2) {
      if (square < 0) return {};
      const double range = (b - std::sqrt(square)) / a;
      const double place = (range * ray_axis - start_axis) / length2;
      if (range > 0 && place >= 0 && place <= 1) {
        const Vector3 normal = range * ray - (capsule.a + place * axis);
        return {range, -ray.dot(normal) / capsule.radius_m};
      }
    }
  }
  const Hit first = trace_ball(capsule.a, capsule.radius_m, ray);
  const Hit second = trace_ball(capsule.b, capsule.radius_m, ray);
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
