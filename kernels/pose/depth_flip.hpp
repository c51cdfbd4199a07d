// Second pose in which a flat tool looks nearly the same (depth reversal ambiguity): its plane
// mirrored in depth.
//
// What:     n the direction in which the tool's markers spread least, v the viewing direction of
//           their mean: the pose rotated by (I - 2 v v')(I - 2 n n') about that mean. A flat tool
//           keeps its outline, and the depth of each marker relative to the mean changes its sign.
// Cost:     one pass over the markers and the square of a 3x3 matrix, three times.
// Worst:    data independent. If the markers spread equally in all directions, any direction
//           serves: there is no second pose.
// Accuracy: the direction is exact for a flat tool; otherwise within (least / second spread)^8 of
//           it.
// Source:   Schweighofer and Pinz 2006, Robust pose estimation from a planar target, section 3, on
//           the two minima; here the second is an initial guess, and the fit finds it. The
//           direction: the adjugate of a matrix has the same eigenvectors, and its largest
//           eigenvalue belongs to the least spread.
#pragma once

#include <span>

#include "kernels/geometry.hpp"
#include "kernels/nonblocking.hpp"
#include "kernels/pose/weighted_marker.hpp"

namespace glint {

// Unit vector, tool frame: direction in which the markers spread least about their mean.
[[nodiscard]] Vector3 flattest_direction(std::span<const WeightedMarker> markers,
                                         const Vector3& mean_m) noexcept GLINT_NONBLOCKING;

// flattest: as above; mean_m: the markers' mean; both in the tool's frame.
[[nodiscard]] Pose depth_flipped(const Pose& T_camera_tool, const Vector3& flattest,
                                 const Vector3& mean_m) noexcept GLINT_NONBLOCKING;

}  // namespace glint
