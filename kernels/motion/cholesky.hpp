// Cholesky factorisation of a small symmetric positive definite matrix: solve, inverse, quadratic
// form.
//
// What:     A = L L'; L^-1 b; A^-1; b' A^-1 b. Of A the lower half is read.
// Cost:     N^3 / 6 multiplications and N roots; 6x6: 0.1 us.
// Worst:    a matrix that is not positive definite: `positive` is false, the factor is invalid.
// Accuracy: backward stable, N units in the last place of the largest element.
// Source:   Golub and Van Loan 2013, algorithm 4.2.1 and equation (3.1.2). Not Eigen's: its code
//           path reads a cache block size behind a lock and can allocate from the heap.
#pragma once

#include <cmath>

#include "kernels/geometry.hpp"

namespace glint {

template <int N>
struct Cholesky {
  using Square = Eigen::Matrix<double, N, N>;
  using Column = Eigen::Matrix<double, N, 1>;

  Square lower = Square::Zero();
  bool positive = true;  // positive definite; false also for numbers that are not finite

  explicit Cholesky(const Square& matrix) {
    for (int c = 0; c < N; ++c) {
      for (int r = c; r < N; ++r) {
        double rest = matrix(r, c);
        for (int k = 0; k < c; ++k) rest -= lower(r, k) * lower(c, k);
        if (r == c) {
          if (!(rest > 0 && std::isfinite(rest))) {
            positive = false;
            return;
          }
          lower(c, c) = std::sqrt(rest);
        } else {
          lower(r, c) = rest / lower(c, c);
        }
      }
    }
  }

  // L^-1 b
  [[nodiscard]] Column forward(const Column& b) const {
    Column x = b;
    for (int r = 0; r < N; ++r) {
      for (int k = 0; k < r; ++k) x(r) -= lower(r, k) * x(k);
      x(r) /= lower(r, r);
    }
    return x;
  }

  // A^-1 b
  [[nodiscard]] Column solve(const Column& b) const {
    Column x = forward(b);
    for (int r = N - 1; r >= 0; --r) {
      for (int k = r + 1; k < N; ++k) x(r) -= lower(k, r) * x(k);
      x(r) /= lower(r, r);
    }
    return x;
  }

  // b' A^-1 b
  [[nodiscard]] double squared_length(const Column& b) const { return forward(b).squaredNorm(); }

  [[nodiscard]] Square inverse() const {
    Square columns;
    for (int c = 0; c < N; ++c) columns.col(c) = solve(Column::Unit(c));
    return 0.5 * (columns + columns.transpose());
  }
};

}  // namespace glint
