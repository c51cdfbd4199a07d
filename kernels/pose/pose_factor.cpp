#include "kernels/pose/pose_factor.hpp"

#include <cmath>

namespace glint {
namespace {

// Minimum pivot, relative to its diagonal element. In a direction that the matrix does not
// determine, rounding leaves 1e-15.
constexpr double k_pivot_min = 1e-12;

}  // namespace

Result<PoseFactor> pose_factor(const Matrix6& matrix) noexcept {
  Result<PoseFactor> result;
  Matrix6& lower = result.value.lower;
  for (int c = 0; c < 6; ++c) {
    double square = matrix(c, c);
    for (int k = 0; k < c; ++k) square -= lower(c, k) * lower(c, k);
    const bool left = square > k_pivot_min * matrix(c, c) && matrix(c, c) > 0;
    if (!left || !std::isfinite(square)) return {{}, Reason::degenerate};
    const double inverse = 1 / std::sqrt(square);
    result.value.inverse_diagonal(c) = inverse;
    for (int r = c + 1; r < 6; ++r) {
      double rest = matrix(r, c);
      for (int k = 0; k < c; ++k) rest -= lower(r, k) * lower(c, k);
      lower(r, c) = rest * inverse;
    }
  }
  return result;
}

Vector6 PoseFactor::solve(const Vector6& right_side) const noexcept {
  Vector6 x = right_side;
  for (int c = 0; c < 6; ++c) {
    x(c) *= inverse_diagonal(c);
    for (int r = c + 1; r < 6; ++r) x(r) -= lower(r, c) * x(c);
  }
  for (int r = 5; r >= 0; --r) {
    for (int k = r + 1; k < 6; ++k) x(r) -= lower(k, r) * x(k);
    x(r) *= inverse_diagonal(r);
  }
  return x;
}

Matrix6 PoseFactor::inverse() const noexcept {
  Matrix6 half;  // L^-1, lower
  for (int c = 0; c < 6; ++c) {
    half(c, c) = inverse_diagonal(c);
    for (int r = c + 1; r < 6; ++r) {
      double sum = 0;
      for (int k = c; k < r; ++k) sum -= lower(r, k) * half(k, c);
      half(r, c) = sum * inverse_diagonal(r);
    }
  }
  Matrix6 out;
  for (int c = 0; c < 6; ++c) {
    for (int r = c; r < 6; ++r) {
      double sum = 0;
      for (int k = r; k < 6; ++k) sum += half(k, r) * half(k, c);
      out(r, c) = out(c, r) = sum;
    }
  }
  return out;
}

}  // namespace glint
