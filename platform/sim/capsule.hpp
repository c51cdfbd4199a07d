// Ray-capsule intersection.
#pragma once

#include "kernels/geometry.hpp"
#include "platform/sim/scenario.hpp"

namespace glint::sim {

struct Hit {
  double range_m = 0;  // along the unit ray; 0: no hit
  double cosine = 0;   // of the angle between the normal and the reversed ray
  [[nodiscard]] explicit operator bool() const { return range_m > 0; }
};

// Returns the nearest hit of a unit ray from the origin. No hit if the origin is inside.
[[nodiscard]] Hit trace(const Capsule& capsule, const Vector3& unit_ray);

// Returns the smallest distance between the capsule's axis and the segment from the origin to
// `end`.
[[nodiscard]] double axis_distance(const Capsule& capsule, const Vector3& end);

[[nodiscard]] Capsule transformed(const Pose& T_a_b, const Capsule& in_b);

}  // namespace glint::sim
