#include "platform/tools/reference/touched_base.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "kernels/angles.hpp"
#include "kernels/motion/interpolate.hpp"
#include "kernels/motion/motion_state.hpp"
#include "kernels/pose/lever_arm.hpp"
#include "kernels/pose/rigid_fit.hpp"
#include "platform/dense.hpp"
#include "platform/input_error.hpp"

namespace glint {
namespace {

constexpr int k_steps_max = 30;
constexpr double k_step_min = 1e-12;  // m and rad
// As for a base that is found in images (README.md).
constexpr double k_sigma_max_m = 0.020, k_sigma_max_rad = 2 * k_radians_per_degree;

// The value that chi-square of n degrees of freedom exceeds once in 1000, to 2 % from n = 3 on
// (Wilson and Hilferty 1931).
double chi_square_limit(double n) {
  constexpr double k_quantile = 3.0902;  // of the standard normal distribution
  const double part = 2 / (9 * n);
  return n * std::pow(1 - part + k_quantile * std::sqrt(part), 3);
}

std::string mm_text(double metres) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f mm", 1e3 * metres);
  return text;
}

Pose initial_fit(std::span<const TouchedPoint> points, const std::string& what) {
  std::vector<Vector3> known, tips;
  for (const TouchedPoint& point : points) {
    known.push_back(point.known_m);
    tips.push_back(point.tip_m);
  }
  const RigidFit fit = fit_rigid(known, tips);
  switch (fit.reason) {
    case Reason::none:
      return fit.transform;
    case Reason::out_of_range:
      throw InputError(what + ": a coordinate is not finite; expected finite numbers");
    case Reason::collinear:
      throw InputError(what +
                       ": the points lie on a line, so the rotation about it is open; "
                       "expected one beside it");
    default:
      throw InputError(what + ": the points coincide; expected them some 100 mm apart");
  }
}

struct Normal {
  Matrix6 information = Matrix6::Zero();
  Vector6 right = Vector6::Zero();
  double chi_square = 0;
};

Normal normal_equations(std::span<const TouchedPoint> points, const Pose& T_frame_base) {
  Normal sum;
  for (const TouchedPoint& point : points) {
    const Vector3 lever = T_frame_base.rotation * point.known_m;
    const Vector3 miss = point.tip_m - T_frame_base.translation - lever;
    const Matrix3 weight = point.own_m2.inverse();
    const Eigen::Matrix<double, 3, 6> jacobian = point_by_pose(lever);
    sum.information += jacobian.transpose() * weight * jacobian;
    sum.right += jacobian.transpose() * weight * miss;
    sum.chi_square += miss.dot(weight * miss);
  }
  return sum;
}

std::string refusal(const TouchedBase& base, std::span<const TouchedPoint> points) {
  if (base.chi_square > base.chi_square_max) {
    const auto worst = std::max_element(base.distances_m.begin(), base.distances_m.end());
    return "the touches do not fit the known points: " +
           points[static_cast<std::size_t>(worst - base.distances_m.begin())].name + " is " +
           mm_text(*worst) +
           " off; expected the points in the order of the touches, in the base's "
           "frame";
  }
  const double sigma_m = largest_sigma(base.covariance.topLeftCorner<3, 3>());
  const double sigma_rad = largest_sigma(base.covariance.bottomRightCorner<3, 3>());
  if (sigma_m <= k_sigma_max_m && sigma_rad <= k_sigma_max_rad) return {};
  char text[160];
  std::snprintf(text, sizeof text,
                "the standard deviation is %.1f mm and %.2f deg; expected at most %.0f mm and %.0f "
                "deg: touch more points, farther apart",
                1e3 * sigma_m, k_degrees_per_radian * sigma_rad, 1e3 * k_sigma_max_m,
                k_degrees_per_radian * k_sigma_max_rad);
  return text;
}

}  // namespace

TouchedBase touched_base(std::span<const TouchedPoint> points, const std::string& what) {
  if (points.size() < k_known_points_min || points.size() > k_known_points_max) {
    throw InputError(what + ": " + std::to_string(points.size()) + " points; expected " +
                     std::to_string(k_known_points_min) + " to " +
                     std::to_string(k_known_points_max));
  }
  TouchedBase base;
  base.T_frame_base = initial_fit(points, what);
  Normal normal = normal_equations(points, base.T_frame_base);
  for (int step = 0; step < k_steps_max; ++step) {
    const Vector6 change = solve_symmetric(normal.information, normal.right);
    const Vector3 turn = change.tail<3>();
    base.T_frame_base.translation += change.head<3>();
    base.T_frame_base.rotation =
        (from_rotation_vector(turn) * base.T_frame_base.rotation).normalized();
    normal = normal_equations(points, base.T_frame_base);
    if (change.cwiseAbs().maxCoeff() < k_step_min) break;
  }
  base.covariance = inverse_of(normal.information);
  for (const TouchedPoint& point : points) {
    base.covariance.topLeftCorner<3, 3>() += point.shared_m2 / static_cast<double>(points.size());
    base.distances_m.push_back((point.tip_m - base.T_frame_base * point.known_m).norm());
  }
  base.chi_square = normal.chi_square;
  base.chi_square_max = chi_square_limit(3 * static_cast<double>(points.size()) - 6);
  base.reason = refusal(base, points);
  return base;
}

}  // namespace glint
