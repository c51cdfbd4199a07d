#include "platform/tools/programming/stroke_moves.hpp"

#include <cmath>
#include <numbers>

#include "kernels/motion/interpolate.hpp"

namespace glint {
namespace {

// Where two segments meet near a point: alternate projections converge to a point of both, if they
// cross, and else to where they are closest. A junction that leaves the point is not taken.
Vector3 junction(const StrokeSegment& before, const StrokeSegment& after,
                 const UncertainPose& point, double spacing_m) {
  constexpr int k_projections = 20;
  const Vector3 at = point.pose.translation;
  const Vector3 middle = 0.5 * (nearest_on(before, at) + nearest_on(after, at));
  Vector3 met = middle;
  for (int i = 0; i < k_projections; ++i) met = nearest_on(after, nearest_on(before, met));
  const double sigma_m = std::sqrt(point.covariance.topLeftCorner<3, 3>().trace() / 3);
  return (met - at).norm() <= spacing_m + 3 * sigma_m ? met : middle;
}

// The pose on an arc at a share of the way from `from` to `to`.
Pose on_arc(const StrokeSegment& arc, const Pose& from, const Pose& to, double angle,
            double share) {
  const Quaternion turned(Eigen::AngleAxisd(share * angle, arc.direction));
  return {slerp(from.rotation, to.rotation, share),
          nearest_on(arc, arc.point + turned * (from.translation - arc.point))};
}

void add_arc(const StrokeSegment& arc, double angle, const Pose& to,
             std::vector<StrokeMove>& moves) {
  constexpr double k_one_move_max = 0.9 * std::numbers::pi;
  const Pose from = moves.back().pose;
  if (angle > k_one_move_max)
    moves.push_back({on_arc(arc, from, to, angle, 0.5), on_arc(arc, from, to, angle, 0.25)});
  moves.push_back({to, on_arc(arc, from, to, angle, angle > k_one_move_max ? 0.75 : 0.5)});
}

}  // namespace

std::vector<StrokeMove> stroke_moves(const std::vector<UncertainPose>& points,
                                     const std::optional<SegmentSettings>& settings) {
  const auto pose_at = [&](std::size_t i, const Vector3& position) {
    return Pose{points[i].pose.rotation.normalized(), position};
  };
  std::vector<StrokeMove> moves;
  if (!settings || points.size() < 2) {
    for (std::size_t i = 0; i < points.size(); ++i)
      moves.push_back({pose_at(i, points[i].pose.translation)});
    return moves;
  }
  const std::vector<StrokeSegment> segments = stroke_segments(points, *settings);
  moves.push_back({pose_at(0, nearest_on(segments.front(), points.front().pose.translation))});
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const StrokeSegment& segment = segments[i];
    const std::size_t last = segment.last;
    if (segment.kind == SegmentKind::free) {
      for (std::size_t p = segment.first + 1; p < last; ++p)
        moves.push_back({pose_at(p, points[p].pose.translation)});
    }
    const double spacing_m =
        (points[last].pose.translation - points[last - 1].pose.translation).norm();
    const bool ends = i + 1 == segments.size();
    const Pose to =
        pose_at(last, ends ? nearest_on(segment, points[last].pose.translation)
                           : junction(segment, segments[i + 1], points[last], spacing_m));
    if (segment.kind == SegmentKind::arc) {
      add_arc(segment, arc_angles(points, segment).back(), to, moves);
    } else {
      moves.push_back({to});
    }
  }
  return moves;
}

}  // namespace glint
