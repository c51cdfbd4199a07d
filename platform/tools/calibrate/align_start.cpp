#include "platform/tools/calibrate/align_start.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/pose/best_rotation.hpp"
#include "platform/dense.hpp"
#include "platform/tools/calibrate/robust.hpp"

namespace glint {
namespace {

constexpr int k_reweightings = 10;
constexpr double k_turn_min_rad = 0.03;         // smaller rotations determine their axis poorly
constexpr double k_turn_difference_rad = 0.04;  // both trackers observe the same angle

MotionSegment piece_of(std::span<const TimedPose> four) {
  MotionSegment piece;
  for (std::size_t i = 0; i < 4; ++i) {
    piece.seconds[i] = 1e-9 * static_cast<double>(four[i].time.nanoseconds);
    piece.position_m[i] = four[i].pose.translation;
  }
  piece.rotation[0] = four[1].pose.rotation;
  piece.rotation[1] = four[2].pose.rotation;
  if (piece.rotation[0].dot(piece.rotation[1]) < 0) piece.rotation[1].coeffs() *= -1;
  return piece;
}

Pose reference_of(const AlignSample& sample, double offset_s) {
  const PoseOf<double> seen = interpolated_pose(sample.reference, sample.seconds + offset_s);
  return {seen.rotation, seen.translation};
}

// Rotation of y, which aligns the body's relative rotations with the tool's: beta = R_y^T alpha.
Quaternion rotation_y(std::span<const AlignSample> samples, double offset_s) {
  Matrix3 sum = Matrix3::Zero();
  const std::size_t n = samples.size();
  for (const std::size_t apart : {n / 2, n / 4, n / 8, n / 16 + 1}) {
    for (std::size_t i = 0; i + apart < n; ++i) {
      const AlignSample &a = samples[i], &b = samples[i + apart];
      const Vector3 tool =
          rotation_vector((a.pose.rotation.conjugate() * b.pose.rotation).normalized());
      const Vector3 body = rotation_vector(
          (reference_of(a, offset_s).rotation.conjugate() * reference_of(b, offset_s).rotation)
              .normalized());
      const double angle = tool.norm();
      if (angle < k_turn_min_rad || angle > 3.0 ||
          std::abs(angle - body.norm()) > k_turn_difference_rad)
        continue;
      sum += tool * body.transpose();
    }
  }
  return sum.norm() > 0 ? best_rotation(sum) : Quaternion::Identity();
}

Quaternion rotation_x(std::span<const AlignSample> samples, const Quaternion& y, double offset_s) {
  Matrix3 sum = Matrix3::Zero();
  for (const AlignSample& sample : samples) {
    const Quaternion tool = sample.pose.rotation * y;
    sum += (reference_of(sample, offset_s).rotation * tool.conjugate()).toRotationMatrix();
  }
  return best_rotation(sum);
}

// Solves R_x R t_y + t_x = t_reference - R_x t, reweighted; t_y = 0 without a lever arm.
void translations(std::span<const AlignSample> samples, LeverArm lever_arm, AlignGuess& start) {
  std::vector<double> weights(samples.size(), 1), distances(samples.size());
  for (int round = 0; round < k_reweightings; ++round) {
    Matrix6 normal = Matrix6::Zero();
    Eigen::Matrix<double, 6, 1> right = Eigen::Matrix<double, 6, 1>::Zero();
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const AlignSample& sample = samples[i];
      Eigen::Matrix<double, 3, 6> row;
      row << (start.x.rotation * sample.pose.rotation).toRotationMatrix(), Matrix3::Identity();
      if (lever_arm == LeverArm::none) row.leftCols<3>().setZero();
      const Vector3 seen = reference_of(sample, start.offset_s).translation -
                           start.x.rotation * sample.pose.translation;
      normal += weights[i] * row.transpose() * row;
      right += weights[i] * row.transpose() * seen;
    }
    if (lever_arm == LeverArm::none) normal.topLeftCorner<3, 3>().setIdentity();
    const Eigen::Matrix<double, 6, 1> solution = solve_symmetric(normal, right);
    start.y.translation = solution.head<3>();
    start.x.translation = solution.tail<3>();
    for (std::size_t i = 0; i < samples.size(); ++i) {
      distances[i] = position_residual(samples[i], start).norm();
    }
    const double limit = median_of(distances);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      weights[i] = distances[i] > limit ? limit / distances[i] : 1;
    }
  }
}

}  // namespace

std::vector<AlignSample> paired(std::span<const TimedPose> poses,
                                std::span<const TimedPose> reference, double offset_s,
                                double gap_max_s) {
  std::vector<AlignSample> samples;
  const auto seconds_of = [](const TimedPose& pose) {
    return 1e-9 * static_cast<double>(pose.time.nanoseconds);
  };
  std::size_t after = 2;  // the first reference sample after the time
  for (const TimedPose& pose : poses) {
    const double seconds = seconds_of(pose);
    while (after + 1 < reference.size() && seconds_of(reference[after]) <= seconds + offset_s) {
      ++after;
    }
    if (after + 1 >= reference.size()) break;
    const MotionSegment piece = piece_of(reference.subspan(after - 2, 4));
    if (seconds + offset_s < piece.seconds[1] || seconds + offset_s > piece.seconds[2]) continue;
    if (piece.seconds[3] - piece.seconds[0] > 3 * gap_max_s) continue;
    samples.push_back({seconds, pose.pose, piece, 1, 1});
  }
  return samples;
}

AlignGuess closed_form(std::span<const AlignSample> samples, double offset_s, LeverArm lever_arm) {
  AlignGuess start;
  start.offset_s = offset_s;
  if (lever_arm == LeverArm::unknown) start.y.rotation = rotation_y(samples, offset_s);
  start.x.rotation = rotation_x(samples, start.y.rotation, offset_s);
  translations(samples, lever_arm, start);
  return start;
}

Vector3 position_residual(const AlignSample& sample, const AlignGuess& start) {
  return start.x * (sample.pose * start.y.translation) -
         reference_of(sample, start.offset_s).translation;
}

Vector3 rotation_residual(const AlignSample& sample, const AlignGuess& start) {
  const Quaternion body = start.x.rotation * sample.pose.rotation * start.y.rotation;
  return rotation_vector(
      (body.conjugate() * reference_of(sample, start.offset_s).rotation).normalized());
}

}  // namespace glint
