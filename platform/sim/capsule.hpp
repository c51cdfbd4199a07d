// Ray-capsule intersection.
#pragma once

#include <cmath>

#include "kernels/geometry.hpp"
#include "platform/sim/scenario.hpp"

namespace glint::sim {

struct Hit {
  double range_m = 0;  // along the unit ray; 0: no hit
  double cosine = 0;   // of the angle between the normal and the reversed ray
  [[nodiscard]] explicit operator bool() const { return range_m > 0; }
};

// A capsule before many rays from the origin: the terms that no ray changes are computed once.
class TracedCapsule {
 public:
  explicit TracedCapsule(const Capsule& capsule)
      : capsule_(capsule),
        axis_(capsule.b - capsule.a),
        length2_(axis_.squaredNorm()),
        start_axis_(capsule.a.dot(axis_)),
        c_(length2_ * (capsule.a.squaredNorm() - capsule.radius_m * capsule.radius_m) -
           start_axis_ * start_axis_) {}

  // Returns the nearest hit of a unit ray. No hit if the origin is inside. Solves the quadratic of
  // an infinite cylinder, with the axial components of ray and centre removed.
  [[nodiscard]] Hit trace(const Vector3& unit_ray) const {
    const double ray_axis = unit_ray.dot(axis_);
    const double a = length2_ - ray_axis * ray_axis;
    const double b = length2_ * unit_ray.dot(capsule_.a) - ray_axis * start_axis_;
    const double square = b * b - a * c_;
    const bool along = !(a > 1e-12 * length2_);  // the axis, or no length
    if (!along && square < 0) return {};
    return trace_near(unit_ray, along ? 0 : (b - std::sqrt(square)) / a, ray_axis);
  }

 private:
  // range: of the infinite cylinder; 0: none. Beyond an end, the sphere of that end applies.
  [[nodiscard]] Hit trace_near(const Vector3& unit_ray, double range, double ray_axis) const;

  Capsule capsule_;
  Vector3 axis_;
  double length2_, start_axis_, c_;
};

// Returns the smallest distance between the capsule's axis and the segment from the origin to
// `end`.
[[nodiscard]] double axis_distance(const Capsule& capsule, const Vector3& end);

[[nodiscard]] Capsule transformed(const Pose& T_a_b, const Capsule& in_b);

}  // namespace glint::sim
