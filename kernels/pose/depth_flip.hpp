// The other pose in which a flat tool looks nearly the same: its plane mirrored in depth.
//
// What:     n the direction in which the tool's markers spread least, v the viewing direction of
//           their mean: the pose turned by (I - 2 v v')(I - 2 n n') about that mean. A tool that is
//           flat keeps its outline, and each marker trades its depth before the mean for the same
//           behind it.
// Cost:     one pass over the markers and the square of a 3x3 matrix, three times.
// Worst:    none is worse than another. Of markers that spread alike in all directions any
//           direction serves: there is no second pose to be found.
// Accuracy: the direction exact for a flat tool; else within (least / second spread)^8 of it.
// Source:   Schweighofer and Pinz 2006, Robust pose estimation from a planar target, section 3, on
//           the two minima; here the second is a start, and the fit finds it. The direction: the
//           adjugate of a matrix has its eigenvectors, the least spread's eigenvalue the largest.
#pragma once

#include <span>

#include "kernels/geometry.hpp"
#include "kernels/nonblocking.hpp"
#include "kernels/pose/weighted_marker.hpp"

namespace glint {

// Unit; what is left of the markers' places when their mean is removed is least along it.
[[nodiscard]] Vector3 flattest_direction(std::span<const WeightedMarker> markers,
                                         const Vector3& mean_m) noexcept GLINT_NONBLOCKING;

// flattest: of the tool, in its frame; mean_m: the markers' mean there.
[[nodiscard]] Pose depth_flipped(const Pose& T_camera_tool, const Vector3& flattest,
                                 const Vector3& mean_m) noexcept GLINT_NONBLOCKING;

}  // namespace glint
