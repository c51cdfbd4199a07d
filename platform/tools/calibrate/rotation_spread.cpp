#include "platform/tools/calibrate/rotation_spread.hpp"

#include "platform/dense.hpp"

namespace glint {

RotationSpread rotation_spread(std::span<const TimedPose> poses) {
  RotationSpread result;
  if (poses.empty()) return result;
  Matrix3 mean = Matrix3::Zero();
  for (const TimedPose& pose : poses) mean += pose.pose.rotation.toRotationMatrix();
  mean /= static_cast<double>(poses.size());
  Matrix3 squares = Matrix3::Zero();
  for (const TimedPose& pose : poses) {
    const Matrix3 off = pose.pose.rotation.toRotationMatrix() - mean;
    squares += off.transpose() * off;
  }
  const SymmetricEigen axes = symmetric_eigen(squares / static_cast<double>(poses.size()));
  result.spread_rad = axes.values.cwiseMax(0.0).cwiseSqrt();
  result.directions = axes.vectors;
  return result;
}

}  // namespace glint
