// Takes points off a cloud that lie within thick lines: the tracked pen and hands, which are no
// part of the place that is mapped.
//
// What:     points at most radius_m from the line from `from` to `to` go, the others keep their
//           order. A sphere has both ends in one place.
// Cost:     a point's distance to each line.
// Worst:    all points times all capsules. One that is not finite, or of no radius, takes none off.
// Accuracy: in double.
// Source:   Ericson 2005, "Real-Time Collision Detection", 5.1.2 (closest point on a segment).
#pragma once

#include <span>

#include "kernels/cloud/point_cloud.hpp"
#include "kernels/geometry.hpp"
#include "kernels/nonblocking.hpp"

namespace glint {

inline constexpr int k_left_out_max = 64;  // capsules at a time; the first ones count

struct LeftOut {
  Vector3 from = Vector3::Zero(), to = Vector3::Zero();  // in the cloud's frame
  double radius_m = 0;
};

// Of the points [first, points.count); gives how many went.
int leave_out_capsules(std::span<const LeftOut> capsules, int first,
                       PointCloud& points) noexcept GLINT_NONBLOCKING;

}  // namespace glint
