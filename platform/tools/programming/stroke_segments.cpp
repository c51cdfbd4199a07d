#include "platform/tools/programming/stroke_segments.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>

#include "kernels/motion/interpolate.hpp"

namespace glint {
namespace {

using Points = std::vector<UncertainPose>;

constexpr int k_fit_iterations_max = 8;
constexpr double k_arc_gain_min = 1.5;  // an arc is this many times as long as the line
constexpr double k_arc_angle_max = 1.9 * std::numbers::pi;

// Quantile of the chi-square distribution (Wilson and Hilferty 1931).
double chi_square_limit(double freedom, double sigma) {
  const double part = 2 / (9 * freedom);
  return freedom * std::pow(1 - part + sigma * std::sqrt(part), 3);
}

// Principal axes of the positions, the largest spread first.
struct PrincipalAxes {
  Vector3 mean = Vector3::Zero();
  Matrix3 axes = Matrix3::Identity();
};

PrincipalAxes frame_of(const Points& points, std::size_t first, std::size_t last) {
  PrincipalAxes frame;
  const double count = static_cast<double>(last - first + 1);
  for (std::size_t i = first; i <= last; ++i) frame.mean += points[i].pose.translation / count;
  Matrix3 spread = Matrix3::Zero();
  for (std::size_t i = first; i <= last; ++i) {
    const Vector3 off = points[i].pose.translation - frame.mean;
    spread += off * off.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Matrix3> solver(spread);
  frame.axes << solver.eigenvectors().col(2), solver.eigenvectors().col(1),
      solver.eigenvectors().col(2).cross(solver.eigenvectors().col(1));
  return frame;
}

// One residual of two components with its covariance and Jacobian, in a weighted least squares sum.
template <int N>
struct NormalEquations {
  Eigen::Matrix<double, N, N> information = Eigen::Matrix<double, N, N>::Zero();
  Eigen::Matrix<double, N, 1> right = Eigen::Matrix<double, N, 1>::Zero();
  double chi_square = 0;

  void add(const Vector2& residual, const Eigen::Matrix2d& covariance,
           const Eigen::Matrix<double, 2, N>& jacobian) {
    const Eigen::Matrix2d weight = covariance.inverse();
    chi_square += residual.dot(weight * residual);
    information += jacobian.transpose() * weight * jacobian;
    right -= jacobian.transpose() * weight * residual;
  }
};

Eigen::Matrix2d covariance_along(const UncertainPose& point, const Vector3& u, const Vector3& v) {
  Eigen::Matrix<double, 2, 3> to;
  to << u.transpose(), v.transpose();
  return to * point.covariance.topLeftCorner<3, 3>() * to.transpose();
}

// Line x(s) = mean + s d + (a + b s) u + (c + e s) v, least squares for a, b, c, e.
std::optional<StrokeSegment> line_through(const Points& points, std::size_t first,
                                          std::size_t last) {
  PrincipalAxes frame = frame_of(points, first, last);
  StrokeSegment line{SegmentKind::line, first, last};
  for (int iteration = 0; iteration < 2; ++iteration) {
    const Vector3 d = frame.axes.col(0), u = frame.axes.col(1), v = frame.axes.col(2);
    NormalEquations<4> sum;
    for (std::size_t i = first; i <= last; ++i) {
      const Vector3 off = points[i].pose.translation - frame.mean;
      const double s = off.dot(d);
      Eigen::Matrix<double, 2, 4> jacobian;
      jacobian << -1, -s, 0, 0, 0, 0, -1, -s;
      sum.add({off.dot(u), off.dot(v)}, covariance_along(points[i], u, v), jacobian);
    }
    line.chi_square = sum.chi_square;
    line.point = frame.mean;
    line.direction = d;
    if (iteration > 0) break;
    const Eigen::Vector4d step = sum.information.ldlt().solve(sum.right);
    if (!step.allFinite()) return {};
    frame.mean += step[0] * u + step[2] * v;
    const Vector3 turned = (d + step[1] * u + step[3] * v).normalized();
    frame.axes.col(0) = turned;
    frame.axes.col(1) = (u - u.dot(turned) * turned).normalized();
    frame.axes.col(2) = turned.cross(frame.axes.col(1));
  }
  const Vector3 along = points[last].pose.translation - points[first].pose.translation;
  if (line.direction.dot(along) < 0) line.direction = -line.direction;
  return line;
}

// Centre and radius of the algebraic circle fit (Kasa 1976), in the plane's coordinates.
std::optional<Vector3> circle_guess(const Points& points, std::size_t first, std::size_t last,
                                    const PrincipalAxes& frame) {
  Matrix3 information = Matrix3::Zero();
  Vector3 right = Vector3::Zero();
  for (std::size_t i = first; i <= last; ++i) {
    const Vector3 local = frame.axes.transpose() * (points[i].pose.translation - frame.mean);
    const Vector3 row(local.x(), local.y(), 1);
    information += row * row.transpose();
    right += row * local.head<2>().squaredNorm();
  }
  const Vector3 solution = information.ldlt().solve(right);
  const Vector2 centre = 0.5 * solution.head<2>();
  const double square = solution.z() + centre.squaredNorm();
  if (!(square > 0) || !solution.allFinite()) return {};
  return Vector3(centre.x(), centre.y(), std::sqrt(square));
}

// Angles of the points about the arc's axis from its first point, without jumps.
std::vector<double> arc_angles(const Points& points, const StrokeSegment& arc) {
  const Vector3 x = (points[arc.first].pose.translation - arc.point).normalized();
  const Vector3 y = arc.direction.cross(x);
  std::vector<double> angles;
  for (std::size_t i = arc.first; i <= arc.last; ++i) {
    const Vector3 off = points[i].pose.translation - arc.point;
    double angle = std::atan2(off.dot(y), off.dot(x));
    if (!angles.empty())
      angle += 2 * std::numbers::pi * std::round((angles.back() - angle) / (2 * std::numbers::pi));
    angles.push_back(angle);
  }
  return angles;
}

// Circle: residuals along the radius and the plane's normal, Gauss-Newton for centre, radius and
// plane.
std::optional<StrokeSegment> arc_through(const Points& points, std::size_t first, std::size_t last,
                                         const SegmentSettings& settings) {
  PrincipalAxes frame = frame_of(points, first, last);
  const auto guess = circle_guess(points, first, last, frame);
  if (!guess) return {};
  StrokeSegment arc{SegmentKind::arc, first, last};
  frame.mean += frame.axes.leftCols<2>() * guess->head<2>();
  arc.radius_m = guess->z();
  for (int iteration = 0; iteration < k_fit_iterations_max; ++iteration) {
    NormalEquations<6> sum;
    const Vector3 n = frame.axes.col(2);
    for (std::size_t i = first; i <= last; ++i) {
      const Vector3 local = frame.axes.transpose() * (points[i].pose.translation - frame.mean);
      const double distance = local.head<2>().norm();
      if (!(distance > 0)) return {};
      const Vector2 out = local.head<2>() / distance;
      Eigen::Matrix<double, 2, 6> jacobian;
      jacobian << -out.x(), -out.y(), -1, 0, 0, 0, 0, 0, 0, -1, -local.x(), -local.y();
      sum.add({distance - arc.radius_m, local.z()},
              covariance_along(points[i], frame.axes.leftCols<2>() * out, n), jacobian);
    }
    arc.chi_square = sum.chi_square;
    const Eigen::Matrix<double, 6, 1> step = sum.information.ldlt().solve(sum.right);
    if (!step.allFinite()) return {};
    if (iteration + 1 == k_fit_iterations_max || step.head<4>().norm() < 1e-9) break;
    frame.mean += frame.axes * Vector3(step[0], step[1], step[3]);
    arc.radius_m += step[2];
    const Vector3 normal =
        (n - frame.axes.col(0) * step[4] - frame.axes.col(1) * step[5]).normalized();
    frame.axes.col(2) = normal;
    frame.axes.col(0) = (frame.axes.col(0) - frame.axes.col(0).dot(normal) * normal).normalized();
    frame.axes.col(1) = normal.cross(frame.axes.col(0));
  }
  if (!(arc.radius_m > 0 && arc.radius_m <= settings.radius_max_m)) return {};
  arc.point = frame.mean;
  arc.direction = frame.axes.col(2);
  double angle = arc_angles(points, arc).back();
  if (angle < 0) arc.direction = -arc.direction;
  if (std::abs(angle) > k_arc_angle_max) return {};
  return arc;
}

bool turns_evenly(const Points& points, std::size_t first, std::size_t last, double turn_max_rad) {
  double length = 0;
  for (std::size_t i = first + 1; i <= last; ++i)
    length += (points[i].pose.translation - points[i - 1].pose.translation).norm();
  double done = 0;
  const Quaternion &from = points[first].pose.rotation, &to = points[last].pose.rotation;
  for (std::size_t i = first + 1; i < last; ++i) {
    done += (points[i].pose.translation - points[i - 1].pose.translation).norm();
    const Quaternion expected = slerp(from, to, length > 0 ? std::min(done / length, 1.0) : 0);
    if (rotation_vector(expected.conjugate() * points[i].pose.rotation).norm() > turn_max_rad)
      return false;
  }
  return true;
}

using Fit = std::function<std::optional<StrokeSegment>(std::size_t first, std::size_t last)>;

class Divider {
 public:
  Divider(const Points& points, const SegmentSettings& settings)
      : points_(points), settings_(settings) {}

  std::vector<StrokeSegment> run() const {
    std::vector<StrokeSegment> segments;
    for (std::size_t first = 0; first + 1 < points_.size();) {
      const StrokeSegment next = longest_at(first);
      const bool joins = next.kind == SegmentKind::free && !segments.empty() &&
                         segments.back().kind == SegmentKind::free;
      if (joins) {
        segments.back().last = next.last;
      } else {
        segments.push_back(next);
      }
      first = next.last;
    }
    for (std::size_t i = 1; i < segments.size(); ++i) move_junction(segments[i - 1], segments[i]);
    return segments;
  }

 private:
  std::optional<StrokeSegment> line(std::size_t first, std::size_t last) const {
    return accepted(line_through(points_, first, last), 4);
  }
  std::optional<StrokeSegment> arc(std::size_t first, std::size_t last) const {
    return accepted(arc_through(points_, first, last, settings_), 6);
  }
  std::optional<StrokeSegment> accepted(std::optional<StrokeSegment> fit, double unknowns) const {
    if (!fit) return {};
    const double freedom = 2.0 * static_cast<double>(fit->last - fit->first + 1) - unknowns;
    const bool agrees = freedom > 0 &&
                        fit->chi_square <= chi_square_limit(freedom, settings_.quantile_sigma) &&
                        turns_evenly(points_, fit->first, fit->last, settings_.turn_max_rad);
    return agrees ? fit : std::nullopt;
  }

  // The largest of the runs that double in size, then longer by bisection. A short run may fail
  // where a longer one agrees: few points hardly determine an arc.
  std::optional<StrokeSegment> longest(std::size_t first, std::size_t count, const Fit& fit) const {
    const std::size_t all = points_.size() - 1 - first;  // steps to the last point
    if (count - 1 > all) return {};
    if (const auto whole = fit(first, first + all)) return whole;
    std::optional<StrokeSegment> best;
    std::size_t low = 0;
    for (std::size_t size = count - 1; size < all; size *= 2) {
      if (const auto next = fit(first, first + size)) {
        best = next;
        low = size;
      }
    }
    std::size_t high = std::min(2 * low, all);
    while (best && high - low > 1) {
      const std::size_t middle = low + (high - low) / 2;
      if (const auto next = fit(first, first + middle)) {
        best = next;
        low = middle;
      } else {
        high = middle;
      }
    }
    return best;
  }

  StrokeSegment longest_at(std::size_t first) const {
    const auto straight =
        longest(first, settings_.points_min, [&](auto a, auto b) { return line(a, b); });
    const auto round =
        longest(first, settings_.points_min + 2, [&](auto a, auto b) { return arc(a, b); });
    const double straight_points = straight ? static_cast<double>(straight->last - first) : 0;
    if (round && static_cast<double>(round->last - first) > k_arc_gain_min * straight_points)
      return *round;
    if (straight) return *straight;
    return {SegmentKind::free, first, first + 1};
  }

  std::optional<StrokeSegment> again(const StrokeSegment& segment, std::size_t first,
                                     std::size_t last) const {
    const std::size_t count =
        segment.kind == SegmentKind::line ? settings_.points_min : settings_.points_min + 2;
    if (last < first + count - 1) return {};
    return segment.kind == SegmentKind::line ? line(first, last) : arc(first, last);
  }

  // A run includes some points beyond a corner that the noise hides.
  void move_junction(StrokeSegment& before, StrokeSegment& after) const {
    if (before.kind == SegmentKind::free || after.kind == SegmentKind::free) return;
    const StrokeSegment first = before, second = after;
    double least = first.chi_square + second.chi_square;
    for (std::size_t at = first.first + 1; at < first.last; ++at) {
      const auto shorter = again(first, first.first, at), longer = again(second, at, second.last);
      if (!shorter || !longer || shorter->chi_square + longer->chi_square >= least) continue;
      least = shorter->chi_square + longer->chi_square;
      before = *shorter;
      after = *longer;
    }
  }

  const Points& points_;
  const SegmentSettings& settings_;
};

}  // namespace

std::vector<StrokeSegment> stroke_segments(const std::vector<UncertainPose>& points,
                                           const SegmentSettings& settings) {
  return Divider(points, settings).run();
}

Vector3 nearest_on(const StrokeSegment& segment, const Vector3& position) {
  const Vector3 off = position - segment.point;
  if (segment.kind == SegmentKind::free) return position;
  if (segment.kind == SegmentKind::line)
    return segment.point + off.dot(segment.direction) * segment.direction;
  const Vector3 in_plane = off - off.dot(segment.direction) * segment.direction;
  const double length = in_plane.norm();
  return length > 0 ? Vector3(segment.point + segment.radius_m / length * in_plane) : position;
}

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
