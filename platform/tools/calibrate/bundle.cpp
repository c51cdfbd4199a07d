#include "platform/tools/calibrate/bundle.hpp"

#include <algorithm>
#include <cmath>

#include "platform/dense.hpp"

namespace glint {

Vector3 bundle_residual(const Bundle& bundle, const LabelledPoint& point) {
  return bundle.poses[point.frame] * bundle.markers_m[point.marker] - point.measured_m;
}

double bundle_noise(const Bundle& bundle, std::span<const LabelledPoint> points) {
  double squares = 0;
  for (const LabelledPoint& point : points) squares += bundle_residual(bundle, point).squaredNorm();
  const double unknowns = 6.0 * static_cast<double>(bundle.poses.size()) +
                          3.0 * static_cast<double>(bundle.markers_m.size()) - 6.0;
  const double degrees_of_freedom = 3.0 * static_cast<double>(points.size()) - unknowns;
  return std::sqrt(squares / std::max(degrees_of_freedom, 1.0));
}

std::vector<double> marker_sigmas(const Bundle& bundle, std::span<const LabelledPoint> points,
                                  double noise_m) {
  const auto size = static_cast<Eigen::Index>(3 * bundle.markers_m.size());
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(size, size);
  // Per frame: the markers' part A^T A, minus the pose's part A^T B (B^T B)^-1 B^T A.
  for (std::size_t frame = 0; frame < bundle.poses.size(); ++frame) {
    Matrix6 pose = Matrix6::Zero();
    Eigen::MatrixXd mixed = Eigen::MatrixXd::Zero(size, 6);
    for (const LabelledPoint& point : points) {
      if (point.frame != frame) continue;
      // In the tool's axes: d miss / d marker = 1, d miss / d pose = [-[marker]x, 1].
      const Vector3& m = bundle.markers_m[point.marker];
      Eigen::Matrix<double, 3, 6> row;
      row << 0, m.z(), -m.y(), 1, 0, 0,  //
          -m.z(), 0, m.x(), 0, 1, 0,     //
          m.y(), -m.x(), 0, 0, 0, 1;
      const auto at = static_cast<Eigen::Index>(3 * point.marker);
      information.block<3, 3>(at, at) += Matrix3::Identity();
      mixed.middleRows<3>(at) += row;
      pose += row.transpose() * row;
    }
    const Eigen::MatrixXd taken = mixed.lazyProduct(pseudo_inverse_of(pose));
    information -= taken.lazyProduct(mixed.transpose());
  }
  // The position and rotation of the tool frame are gauge freedoms: skips the six null directions.
  const SymmetricEigen modes = symmetric_eigen(information);
  std::vector<double> sigmas;
  for (Eigen::Index at = 0; at < size; at += 3) {
    double variance = 0;
    for (Eigen::Index i = 6; i < size; ++i) {
      variance +=
          modes.vectors.col(i).segment<3>(at).squaredNorm() / std::max(modes.values[i], 1e-12);
    }
    sigmas.push_back(noise_m * std::sqrt(variance / 3));
  }
  return sigmas;
}

}  // namespace glint
