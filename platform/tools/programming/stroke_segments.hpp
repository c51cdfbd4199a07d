// Divides a stroke into straight lines, arcs of circles and free parts; the covariance decides.
//
// Method: from each start the longest run of points is searched whose residuals from a fitted line
// agree with the points' covariances (chi-square test), and the longest for an arc. An arc is taken
// if it is clearly longer. The junction of two segments is then moved to the point at which the sum
// of both squared Mahalanobis distances is least. A segment also ends where the tool's rotation
// leaves the interpolation between its ends. Points' errors are taken as independent; errors that
// points share make the test accept more.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "kernels/motion/motion_state.hpp"

namespace glint {

enum class SegmentKind : std::uint8_t { free, line, arc };

// From point `first` to point `last` of the stroke; neighbours share a point.
struct StrokeSegment {
  SegmentKind kind = SegmentKind::free;
  std::size_t first = 0, last = 0;
  double chi_square = 0;  // of the residuals; free: 0
  // A line's point and direction; an arc's centre, axis (it turns to the left about it) and radius.
  Vector3 point = Vector3::Zero(), direction = Vector3::UnitZ();
  double radius_m = 0;
};

struct SegmentSettings {
  double quantile_sigma = 3;     // of the chi-square test: 3 is 99.9 %
  double turn_max_rad = 0.0873;  // of the rotation from the interpolated one: 5 deg
  double radius_max_m = 1;       // a larger arc is no arc
  std::size_t points_min = 6;    // of a line; an arc needs two more
};

// Requires two points or more.
[[nodiscard]] std::vector<StrokeSegment> stroke_segments(const std::vector<UncertainPose>& points,
                                                         const SegmentSettings& settings);

// The point of a line or an arc that is nearest to `position`.
[[nodiscard]] Vector3 nearest_on(const StrokeSegment& segment, const Vector3& position);

// A move of a stroke, to `pose` by a line, or by an arc through `via`. The first one is its begin.
struct StrokeMove {
  Pose pose;  // unit quaternion
  std::optional<Pose> via{};
};

// With settings: one move for each line, one or two for each arc. Corners are where two fitted
// segments meet. Without settings, and in free parts: one move for each point. Requires one point
// or more.
[[nodiscard]] std::vector<StrokeMove> stroke_moves(const std::vector<UncertainPose>& points,
                                                   const std::optional<SegmentSettings>& settings);

}  // namespace glint
