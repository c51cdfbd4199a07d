// Makes flat what is flat: points on a plane that was found are moved onto it.
//
// What:     each point moves along its plane's normal, which becomes its own. What is on a plane
//           planes.hpp and plane_support.hpp
//           have decided: within the threshold *and* with its normal, among others that are. By
//           distance alone a plane swallows the feet of all that stands on it.
// Cost:     linear in the points.
// Worst:    none is worse than another.
// Accuracy: no point moves further than the threshold, up to the rounding of its coordinates.
// Source:   Puljiz et al., section on referencing: points near a plane are moved onto it.
#pragma once

#include "kernels/cloud/plane_support.hpp"
#include "kernels/cloud/planes.hpp"

namespace glint {

// Points [from, from + most) of the cloud that was searched; gives the first one not yet looked at.
int snap_to_planes(const PlaneSearch& planes, const PlaneSupport& support, int from, int most,
                   PointCloud& points) noexcept GLINT_NONBLOCKING;

}  // namespace glint
