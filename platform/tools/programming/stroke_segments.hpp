// Divides a stroke into straight lines, arcs of circles and free parts; the covariance decides.
//
// Method: from each start the longest run of points is searched whose residuals from a fitted line
// agree with the points' covariances (chi-square test), and the longest for an arc. An arc is taken
// if it is clearly longer. The junction of two segments is then moved to the point at which the sum
// of both squared Mahalanobis distances is least. A segment also ends where the tool's rotation
// leaves the interpolation between its ends. Points' errors are taken as independent; errors that
// points share make the test accept more.
#pragma once

#include <vector>

#include "platform/tools/programming/segment_fit.hpp"

namespace glint {

struct SegmentSettings {
  double quantile_sigma = 3;     // of the chi-square test: 3 is 99.9 %
  double turn_max_rad = 0.0873;  // of the rotation from the interpolated one: 5 deg
  double radius_max_m = 1;       // a larger arc is no arc
  std::size_t points_min = 6;    // of a line; an arc needs two more
};

// Requires two points or more.
[[nodiscard]] std::vector<StrokeSegment> stroke_segments(const std::vector<UncertainPose>& points,
                                                         const SegmentSettings& settings);

}  // namespace glint
