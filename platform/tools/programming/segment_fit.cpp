#include "platform/tools/programming/segment_fit.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>

namespace glint {
namespace {

using Points = std::vector<UncertainPose>;

constexpr int k_fit_iterations_max = 8;
constexpr double k_arc_angle_max = 1.9 * std::numbers::pi;

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
struct FitEquations {
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

}  // namespace

// Line x(s) = mean + s d + (a + b s) u + (c + e s) v, least squares for a, b, c, e.
std::optional<StrokeSegment> line_through(const Points& points, std::size_t first,
                                          std::size_t last) {
  PrincipalAxes frame = frame_of(points, first, last);
  StrokeSegment line{SegmentKind::line, first, last};
  for (int iteration = 0; iteration < 2; ++iteration) {
    const Vector3 d = frame.axes.col(0), u = frame.axes.col(1), v = frame.axes.col(2);
    FitEquations<4> sum;
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
                                         double radius_max_m) {
  PrincipalAxes frame = frame_of(points, first, last);
  const auto guess = circle_guess(points, first, last, frame);
  if (!guess) return {};
  StrokeSegment arc{SegmentKind::arc, first, last};
  frame.mean += frame.axes.leftCols<2>() * guess->head<2>();
  arc.radius_m = guess->z();
  for (int iteration = 0; iteration < k_fit_iterations_max; ++iteration) {
    FitEquations<6> sum;
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
  if (!(arc.radius_m > 0 && arc.radius_m <= radius_max_m)) return {};
  arc.point = frame.mean;
  arc.direction = frame.axes.col(2);
  double angle = arc_angles(points, arc).back();
  if (angle < 0) arc.direction = -arc.direction;
  if (std::abs(angle) > k_arc_angle_max) return {};
  return arc;
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

}  // namespace glint
