// Projects the points of each detected plane onto the plane.
//
// What:     moves each point along its plane's normal, which becomes the point's normal. planes.hpp
//           and plane_support.hpp assign points to planes: within the threshold *and* with the
//           plane's normal, among neighbours on the same plane. A distance test alone would also
//           flatten the lower ends of objects that stand on the plane.
// Cost:     linear in the points.
// Worst:    data independent.
// Accuracy: no point moves further than the threshold, up to the rounding of its coordinates.
// Source:   Puljiz et al., section on referencing: points near a plane are moved onto it.
#pragma once

#include "kernels/cloud/plane_support.hpp"
#include "kernels/cloud/planes.hpp"

namespace glint {

// Processes points [from, from + most) of the segmented cloud; returns the first one not yet
// processed.
int snap_to_planes(const PlaneSearch& planes, const PlaneSupport& support, int from, int most,
                   PointCloud& points) noexcept GLINT_NONBLOCKING;

}  // namespace glint
