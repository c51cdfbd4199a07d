#include "platform/tools/calibrate/smooth_series.hpp"

#include <algorithm>

#include "platform/dense.hpp"

namespace glint {
namespace {

constexpr std::size_t k_neighbours = 4;
constexpr double k_reach_s = 0.05;
constexpr int k_samples_min = 5;

// Position, and rotation vector relative to the middle pose, by least squares over 1, t, t^2.
Pose smoothed(std::span<const TimedPose> near, const TimedPose& middle) {
  Matrix3 normal = Matrix3::Zero();
  Eigen::Matrix<double, 3, 6> right = Eigen::Matrix<double, 3, 6>::Zero();
  int count = 0;
  for (const TimedPose& pose : near) {
    const double t = (pose.time - middle.time).seconds() / k_reach_s;
    if (t < -1 || t > 1) continue;
    const Vector3 powers(1, t, t * t);
    const Quaternion turn = (middle.pose.rotation.conjugate() * pose.pose.rotation).normalized();
    Eigen::Matrix<double, 1, 6> value;
    value << pose.pose.translation.transpose(), rotation_vector(turn).transpose();
    normal += powers * powers.transpose();
    right += powers * value;
    ++count;
  }
  if (count < k_samples_min) return middle.pose;
  const Eigen::Matrix<double, 3, 6> solution = solve_symmetric(normal, right);
  return {(middle.pose.rotation * from_rotation_vector(solution.row(0).tail<3>().transpose()))
              .normalized(),
          solution.row(0).head<3>().transpose()};
}

}  // namespace

std::vector<TimedPose> smooth_series(std::span<const TimedPose> poses) {
  std::vector<TimedPose> result;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const std::size_t first = i - std::min(i, k_neighbours);
    const std::size_t last = std::min(i + k_neighbours + 1, poses.size());
    result.push_back({poses[i].time, smoothed(poses.subspan(first, last - first), poses[i])});
  }
  return result;
}

}  // namespace glint
