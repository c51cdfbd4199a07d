#include "platform/lab/experiments/alignment.hpp"

#include <vector>

#include "kernels/motion/interpolate.hpp"
#include "platform/dense.hpp"
#include "platform/tools/calibrate/robust.hpp"

namespace glint {
namespace {

constexpr int k_rounds = 5;  // the inlier set is constant after two or three
constexpr double k_medians_kept = 3;

// Marks as inliers the values within k_medians_kept times the median distance.
std::vector<bool> inliers_of(const std::vector<double>& distances) {
  const double limit = k_medians_kept * median_of(distances);
  std::vector<bool> kept;
  for (const double distance : distances) kept.push_back(distance <= limit);
  return kept;
}

Quaternion mean_rotation(const std::vector<Quaternion>& rotations, const std::vector<bool>& kept) {
  Eigen::Matrix4d sum = Eigen::Matrix4d::Zero();
  for (std::size_t i = 0; i < rotations.size(); ++i)
    if (kept[i]) sum += rotations[i].coeffs() * rotations[i].coeffs().transpose();
  const SymmetricEigen axis = symmetric_eigen(sum);
  return Quaternion(Eigen::Vector4d(axis.vectors.col(3))).normalized();
}

Vector3 mean_vector(const std::vector<Vector3>& vectors, const std::vector<bool>& kept) {
  Vector3 sum = Vector3::Zero();
  double count = 0;
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    if (!kept[i]) continue;
    sum += vectors[i];
    ++count;
  }
  return sum / count;
}

}  // namespace

Pose align_worlds(std::span<const PosePair> samples) {
  if (samples.empty()) return {};
  const std::vector<bool> all(samples.size(), true);

  std::vector<Quaternion> rotations;
  for (const PosePair& sample : samples)
    rotations.push_back(sample.T_reference_tip.rotation * sample.T_world_tip.rotation.conjugate());
  Pose aligned;
  aligned.rotation = mean_rotation(rotations, all);
  for (int round = 0; round < k_rounds; ++round) {
    std::vector<double> distances;
    for (const Quaternion& rotation : rotations)
      distances.push_back(aligned.rotation.angularDistance(rotation));
    aligned.rotation = mean_rotation(rotations, inliers_of(distances));
  }

  std::vector<Vector3> offsets;
  for (const PosePair& sample : samples)
    offsets.push_back(sample.T_reference_tip.translation -
                      aligned.rotation * sample.T_world_tip.translation);
  aligned.translation = mean_vector(offsets, all);
  for (int round = 0; round < k_rounds; ++round) {
    std::vector<double> distances;
    for (const Vector3& offset : offsets)
      distances.push_back((offset - aligned.translation).norm());
    aligned.translation = mean_vector(offsets, inliers_of(distances));
  }
  return aligned;
}

PoseError pose_error(const Pose& T_reference_world, const PosePair& sample) {
  const Pose seen = T_reference_world * sample.T_world_tip;
  return {
      seen.translation - sample.T_reference_tip.translation,
      rotation_vector((seen.rotation * sample.T_reference_tip.rotation.conjugate()).normalized())};
}

}  // namespace glint
