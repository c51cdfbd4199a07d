// Removes the points inside capsules from a point cloud: the tracked pen and hands, which are not
// part of the mapped scene.
//
// What:     removes points within radius_m of the segment from `from` to `to`; the others keep
//           their order. A capsule with equal ends is a sphere.
// Cost:     per point one distance to each capsule.
// Worst:    all points times all capsules. A capsule that is not finite or has no radius removes
//           none.
// Accuracy: double.
// Source:   Ericson 2005, "Real-Time Collision Detection", 5.1.2 (closest point on a segment).
#pragma once

#include <span>

#include "kernels/cloud/point_cloud.hpp"
#include "kernels/geometry.hpp"
#include "kernels/nonblocking.hpp"

namespace glint {

inline constexpr int k_exclusion_capsules_max = 64;  // capsules per call; the first ones count

struct ExclusionCapsule {
  Vector3 from = Vector3::Zero(), to = Vector3::Zero();  // in the cloud's frame
  double radius_m = 0;
};

// Processes the points [first, points.count); returns the number removed.
int leave_out_capsules(std::span<const ExclusionCapsule> capsules, int first,
                       PointCloud& points) noexcept GLINT_NONBLOCKING;

}  // namespace glint
