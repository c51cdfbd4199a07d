// A straight line or an arc of a circle fitted to a run of a stroke's points, weighted by their
// covariances.
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

// None if the points determine no line.
[[nodiscard]] std::optional<StrokeSegment> line_through(const std::vector<UncertainPose>& points,
                                                        std::size_t first, std::size_t last);

// None if the points determine no circle, for a larger radius, or for nearly a whole turn.
[[nodiscard]] std::optional<StrokeSegment> arc_through(const std::vector<UncertainPose>& points,
                                                       std::size_t first, std::size_t last,
                                                       double radius_max_m);

// Angles of the points about the arc's axis from its first point, without jumps.
[[nodiscard]] std::vector<double> arc_angles(const std::vector<UncertainPose>& points,
                                             const StrokeSegment& arc);

// The point of a line or an arc that is nearest to `position`.
[[nodiscard]] Vector3 nearest_on(const StrokeSegment& segment, const Vector3& position);

}  // namespace glint
