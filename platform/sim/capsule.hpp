// Rays against thick lines.
#pragma once

#include "kernels/geometry.hpp"
#include "platform/sim/scenario.hpp"

namespace glint::sim {

struct Hit {
  double range_m = 0;  // along the unit ray; 0: none
  double cosine = 0;   // between the surface's normal and the way back
  [[nodiscard]] explicit operator bool() const { return range_m > 0; }
};

// From the origin along a unit ray, the nearest point ahead. An origin inside has no hit.
[[nodiscard]] Hit trace(const Capsule& capsule, const Vector3& unit_ray);

// The least distance between the segment from the origin to `end` and the capsule's axis.
[[nodiscard]] double axis_distance(const Capsule& capsule, const Vector3& end);

[[nodiscard]] Capsule transformed(const Pose& T_a_b, const Capsule& in_b);

}  // namespace glint::sim
