// Converts 4x4 matrices from files to rigid transforms.
#pragma once

#include <array>
#include <optional>

#include "kernels/geometry.hpp"

namespace glint {

using MatrixNumbers = std::array<double, 16>;

// Row-major, for column vectors: the translation is the last column. Empty if not a rigid transform
// within the precision of floats.
[[nodiscard]] inline std::optional<Pose> pose_of_matrix(const MatrixNumbers& m) {
  constexpr double k_orthogonal = 1e-3;
  Matrix3 rotation;
  rotation << m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10];
  const Vector3 translation(m[3], m[7], m[11]);
  const bool affine = m[12] == 0 && m[13] == 0 && m[14] == 0 && m[15] == 1;
  const double off = (rotation * rotation.transpose() - Matrix3::Identity()).cwiseAbs().maxCoeff();
  if (!affine || !translation.allFinite() || !(off < k_orthogonal) ||
      !(rotation.determinant() > 0)) {
    return std::nullopt;
  }
  return Pose{Quaternion(rotation).normalized(), translation};
}

[[nodiscard]] inline MatrixNumbers transposed(const MatrixNumbers& m) {
  MatrixNumbers out{};
  for (std::size_t i = 0; i < 16; ++i) out[i] = m[4 * (i % 4) + i / 4];
  return out;
}

}  // namespace glint
